// SPDX-License-Identifier: Apache-2.0
// The preview frame, from which the peak and the items' sizes are known, and how far boxes of the pupil are divided.
#pragma once

#include <algorithm>
#include <cmath>

#include "contrejour/frame.h"

namespace contrejour::inline internal::adaptive {

inline constexpr double kPeakQuantile = 0.999;  // of the preview's samples are below the peak
// The most times that a box may be quartered: in general; in the preview and for negligible items.
inline constexpr int kMaxDepth = 4, kPeakMaxDepth = 1;

// The frame's width over that of the preview frame.
[[nodiscard]] inline int preview_scale(const Frame& frame) {
  constexpr int kMaxPeakScale = 8;        // unless the preview would have
  constexpr double kPeakPixels = 2500.0;   // fewer pixels than that
  const double pixels = static_cast<double>(frame.width) * frame.height;
  return std::clamp(static_cast<int>(std::sqrt(pixels / kPeakPixels)), 1, kMaxPeakScale);
}

}  // namespace contrejour::inline internal::adaptive
