// SPDX-License-Identifier: Apache-2.0
// Resamples a picture over a square of the stop plane to the samples of another square: bilinear interpolation, which
// falls to zero within a sample beyond the border. Units: stop radii. Thread-safety: pure.
#pragma once

#include <span>
#include <vector>

namespace contrejour::inline internal::stop_patterns {

// Rows of side x side samples over the square from -extent to extent.
struct SquareSamples {
  int side = 0;
  double extent = 0.0;
  std::span<const float> samples;
};

[[nodiscard]] std::vector<float> resampled(const SquareSamples& from, int side, double extent);

}  // namespace contrejour::inline internal::stop_patterns
