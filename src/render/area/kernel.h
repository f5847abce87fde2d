// What a piece of a light makes of a point of light on the sensor: its shape under a ghost's map, on pixels.
#pragma once

#include <vector>

#include "render/area/light_pieces.h"

namespace contrejour::area {

// How far a kernel's pixels lie from its middle, at most.
struct KernelReach {
  int left = 0, right = 0, up = 0, down = 0;
};

struct Kernel {
  KernelReach reach;
  std::vector<Rgb> weight;  // rows from the top; of each channel they sum to 1
  [[nodiscard]] int width() const { return reach.left + reach.right + 1; }
  [[nodiscard]] int height() const { return reach.up + reach.down + 1; }
};

// The map from tangents to pixels of the level that it is for. The shape is laid on pixels as points, each on its four
// nearest, and drawn so much narrower that its second moments are right. moved: pixels that the picture to be convolved
// was drawn right and down of its place. spread: a variance that what is done afterwards adds, in squares of a pixel,
// as smooth halves do; the shape is narrower by it, too.
[[nodiscard]] Kernel make_kernel(const LightPiece& piece, const LinearMap& px_from_tangents, Vec2 moved,
                                 double spread = 0.0);

// Its size before it is made: no pixel lies farther out.
[[nodiscard]] KernelReach reach_of(const LightPiece& piece, const LinearMap& px_from_tangents);

}  // namespace contrejour::area
