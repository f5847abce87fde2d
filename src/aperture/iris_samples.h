// SPDX-License-Identifier: Apache-2.0
// Resamples a picture over the stop, and computes distances from the line where the samples cross a level.
#pragma once

#include <span>
#include <vector>

namespace contrejour::inline internal {

// On a square of side x side; the outermost ring lies outside the picture.
struct StopSamples {
  int side = 0;
  std::vector<float> value;  // [row from below * side + column]

  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i);
  }
};

// level: rows from the top. The longer side spans the square within the ring: large pictures are averaged, small ones
// interpolated; samples outside the picture are 0.
[[nodiscard]] StopSamples samples_over_stop(std::span<const float> level, int width, int height);

// Signed distance from the line, in samples, negative where the value is at least `level`. The nearest piece of the
// line is propagated between neighbours (Danielsson 1980), which is wrong by less than a sample at a few distant
// points.
[[nodiscard]] StopSamples distances_from_level(const StopSamples& samples, float level);

}  // namespace contrejour::inline internal
