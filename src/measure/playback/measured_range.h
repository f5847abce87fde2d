// SPDX-License-Identifier: Apache-2.0
// How a measured flare fades beyond the angles at which it was measured.
// Thread-safety: pure functions.
#pragma once

#include <algorithm>

namespace contrejour::inline internal {

inline constexpr double kBeyondRange = 0.2;  // of the measured range, over which the flare fades out

// 1 within the measured range, 0 a fifth beyond it.
[[nodiscard]] inline double level_beyond_range(double s, double s_max) {
  return std::clamp(1.0 - (s - s_max) / (kBeyondRange * s_max), 0.0, 1.0);
}

}  // namespace contrejour::inline internal
