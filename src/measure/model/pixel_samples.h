// SPDX-License-Identifier: Apache-2.0
// The mean of a ghost's shade over a pixel is in closed form for a border that is straight across the pixel. A ghost of
// a pixel or two has no such border: its pixels are means over smaller squares, whose border is straighter.
// Thread-safety: pure functions.
#pragma once

#include <algorithm>

#include "contrejour/expert/ghost_outline.h"

namespace contrejour::inline internal {

inline constexpr double kStraight_px = 1.5;  // the half axis from which borders are straight over a pixel
inline constexpr int kSamplesAcross = 4;  // a pixel, for smaller ghosts

// Into how many squares each side of a pixel is divided. pixel: its width.
[[nodiscard]] inline int samples_across(const GhostOutline& outline, double pixel) {
  const double least = std::min(0.5 * (outline.left + outline.right), outline.half_height);
  return least < kStraight_px * pixel ? kSamplesAcross : 1;
}

}  // namespace contrejour::inline internal
