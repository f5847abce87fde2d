// SPDX-License-Identifier: Apache-2.0
// The error that a whole frame may make, and which items must be drawn more finely to keep that limit.
#pragma once

#include <cstddef>
#include <vector>

namespace contrejour::inline internal::adaptive {

// The RMS error over the frame's pixels, as a fraction of the peak.
struct FrameError {
  double error = 0.003, peak = 1.0, pixels = 1.0;
  [[nodiscard]] double squared() const { return error * peak * error * peak * pixels; }  // summed over the pixels
};

// The weight of an error at this level: 1 far below the peak, and falling as 1 / level far above it.
[[nodiscard]] inline double peak_limited_weight(double level, double peak) {
  constexpr double kPeaks = 4.0;  // level over the peak at which an error counts half
  return 1.0 / (1.0 + level / (kPeaks * peak));
}

// The items that remain, in their order, when those with the smallest squared errors are left out as long as these
// together make no more than `allowed`.
[[nodiscard]] std::vector<std::size_t> above_error_limit(std::vector<std::size_t> some,
                                                         const std::vector<double>& error, double allowed);

}  // namespace contrejour::inline internal::adaptive
