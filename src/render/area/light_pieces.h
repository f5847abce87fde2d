// Lights that are no points, in pieces small enough that within each a ghost only moves, by a linear map of the angle.
#pragma once

#include <cstddef>
#include <vector>

#include "contrejour/light.h"
#include "render/area/linear_map.h"

namespace contrejour::area {

// A small square of a piece. Of each channel the shares of all of them sum to 1.
struct ShapeSample {
  Vec2 at;  // tangents from the piece's direction, x to the right, y up
  Rgb share{};
};

struct LightPiece {
  Light point;  // the piece's middle, with its share of the value
  std::vector<ShapeSample> samples;
  Vec2 right, down;      // sides of each sample's square
  LinearMap covariance;  // of the light over the piece, about its middle
  Vec2 middle;           // from the light's direction
  bool is_disc = false;  // the same in every orientation
  bool is_even = false;  // about the same from both sides: discs, and where neighbours fade into one another
};

// What stands for a piece of any light, of which only how wide it is counts: a tent across, of variance 1 along each
// axis, as if of a light.
[[nodiscard]] LightPiece soft_piece();

// So many pieces along the longer side, of about as wide ones along the other. Neighbours fade into one another, so
// that their ghosts do. A point is one piece. Values sum to the light's; of a light that reaches behind the camera that
// part is left out.
[[nodiscard]] std::vector<LightPiece> pieces_of(const Light& light, int across = 1);

}  // namespace contrejour::area
