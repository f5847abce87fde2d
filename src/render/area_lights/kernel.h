// SPDX-License-Identifier: Apache-2.0
// The kernel of a piece of a light: its shape under a ghost's map, on pixels.
#pragma once

#include <vector>

#include "render/area_lights/light_pieces.h"

namespace contrejour::inline internal::area {

// The largest distances of a kernel's pixels from its middle.
struct KernelExtent {
  int left = 0, right = 0, up = 0, down = 0;
};

struct Kernel {
  KernelExtent extent;
  std::vector<Rgb> weight;  // rows from the top; the weights of each channel sum to 1
  [[nodiscard]] int width() const { return extent.left + extent.right + 1; }
  [[nodiscard]] int height() const { return extent.up + extent.down + 1; }
};

// px_from_tangents: to pixels of the level for which the kernel is made. The shape is placed as points, each spread
// over its four nearest pixels, and drawn narrower so that its second moments are right. moved: by how many pixels to
// the right and down the picture is displaced. spread: the variance, in squares of a pixel, that later steps add, as
// Smooth upsampling does; the shape is narrower by it, too.
[[nodiscard]] Kernel make_kernel(const LightPiece& piece, const LinearMap& px_from_tangents, Vec2 moved,
                                 double spread = 0.0);

// The bounds of a kernel, known before it is made.
[[nodiscard]] KernelExtent extent_of(const LightPiece& piece, const LinearMap& px_from_tangents);

}  // namespace contrejour::inline internal::area
