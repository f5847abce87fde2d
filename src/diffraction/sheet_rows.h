// SPDX-License-Identifier: Apache-2.0
// The inner loops of drawing a precomputed starburst: bilinear interpolation between its samples. No weight is
// negative, so that dark pixels next to a spike do not become negative.
#pragma once

#include <array>
#include <cstddef>

namespace contrejour::inline internal {

// out[i] = above[i] + t (below[i] - above[i]).
void blend_rows(const float* above, const float* below, float t, std::size_t count, float* out);

// pixels[i] += scale[i % 3] * (samples[i] + t (samples[i + 3] - samples[i])): interleaved RGB.
void add_between(const float* samples, float t, const std::array<float, 3>& scale, std::size_t count, float* pixels);

}  // namespace contrejour::inline internal
