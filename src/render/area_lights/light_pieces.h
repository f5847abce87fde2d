// SPDX-License-Identifier: Apache-2.0
// Divides lights with a size into pieces so small that within each a ghost only moves, by a linear map of the angle.
#pragma once

#include <cstddef>
#include <vector>

#include "base/linear_map.h"
#include "contrejour/light.h"

namespace contrejour::inline internal::area {

// A small square of a piece. In each channel the fractions of all samples sum to 1.
struct ShapeSample {
  Vec2 at;  // tangents from the piece's direction, x to the right, y up
  Rgb fraction{};
};

struct LightPiece {
  Light point;  // middle of the piece, with its part of the light's value
  std::vector<ShapeSample> samples;
  Vec2 right, down;      // sides of each sample's square
  LinearMap covariance;  // of the light of the piece, about its middle
  Vec2 middle;           // relative to the light's direction
  bool is_disc = false;  // the same in every orientation
  bool is_symmetric = false;  // about the same from both sides: discs, and pieces that fade into neighbours
};

// A substitute for a piece of any light of which only the width counts: a product of tents, with variance 1 along each
// axis.
[[nodiscard]] LightPiece soft_piece();

// Divides a light into `across` pieces along its longer side and into pieces of about the same width along the other.
// Neighbours fade into one another, so that their ghosts do, too. A point light is one piece. Values sum to the
// light's, except for the part of a light that lies behind the camera, which is left out.
[[nodiscard]] std::vector<LightPiece> pieces_of(const Light& light, int across = 1);

}  // namespace contrejour::inline internal::area
