// SPDX-License-Identifier: Apache-2.0
// The errors of a blurred ghost's image that is drawn with less work: in coarser pixels, or with another ghost's blur.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::area {

// In pixels of the frame; radii are across the shorter and the longer axis.
struct BlurredGhost {
  Vec2 blur_px;    // of the light's image that the ghost makes
  Vec2 size_px;    // of the ghost without blur
  double level = 0.0;  // its brightness over the picture's peak
};

// Errors are squared and summed over the frame's pixels, in squares of the peak. They are estimated from a blurred
// edge's profile, the ghost's outline and its brightness: within a factor of 2 for a uniform ghost, worse where it has
// caustics.

// The error of an image with pixels 2^level times as wide.
[[nodiscard]] double level_error(const BlurredGhost& ghost, int level);

// The error of the pixels of this level, 0 or less. A kernel that spans few of them has the right width, but not the
// right shape.
[[nodiscard]] double pixel_error(const BlurredGhost& ghost, int level);

// The error for a pixel's length of an edge with this height over the peak, whose blur's radius is off by
// `displacement_px`.
[[nodiscard]] double misfit_error(double height, double edge_width_px, double displacement_px);

// The error of a ghost that is smaller than a pixel, or a line thinner than one, for pixels 2^level times as wide: its
// place in the pixel is lost. It is the largest, so that it also bounds the step as the ghost moves from pixel to
// pixel. Negligible for others.
[[nodiscard]] double spot_error(const BlurredGhost& ghost, int level);

// The level up to `coarsest` at which a spot makes no more than that error: a negative one is that of a window of fine
// pixels (fine_window.h).
inline constexpr int kFinestLevel = -3;
inline constexpr double kSpotFraction = 0.03;  // of the frame's squared error: what a spot is allowed
[[nodiscard]] int spot_level(const BlurredGhost& ghost, int coarsest, double allowed_squares);

// The levels of all ghosts (image_pyramid.h): fine enough to be safe, and coarser for as many ghosts as together make
// no more error than `allowed_squares`.
[[nodiscard]] std::vector<int> levels_of(std::span<const BlurredGhost> ghosts, double allowed_squares);

}  // namespace contrejour::inline internal::area
