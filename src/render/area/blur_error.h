// What a blurred ghost's picture may be spared: what coarser pixels, or another ghost's blur, make wrong.
#pragma once

#include <span>
#include <vector>

#include "contrejour/vec.h"

namespace contrejour::area {

// In pixels of the frame; radii are those across the shorter and the longer axis.
struct BlurredGhost {
  Vec2 blur_px;    // of the light's image by the ghost
  Vec2 size_px;    // of the ghost before it is blurred
  double level = 0.0;  // of its brightness, over the picture's peak
};

// Errors are squared and summed over the frame's pixels, in squares of the peak. From a blurred edge's profile, the
// ghost's outline and its brightness: within a factor of 2 for an even ghost, more where it has caustics.

// Of a picture of pixels 2^level as wide.
[[nodiscard]] double level_error(const BlurredGhost& ghost, int level);

// The error that the frame's own pixels make, on which kernels narrower than some of them have the right width, but not
// the shape.
[[nodiscard]] double pixel_error(const BlurredGhost& ghost);

// For a pixel's length of an edge of such a height over the peak, whose blur's radius is off by so many pixels.
[[nodiscard]] double misfit_error(double height, double softness_px, double off_px);

// Levels of all (layers.h): fine enough to be safe, and coarser for as many as together make no more error than that.
[[nodiscard]] std::vector<int> levels_of(std::span<const BlurredGhost> ghosts, double allowed_squares);

}  // namespace contrejour::area
