// The inner loops of drawing a starburst that is laid out already: places between its samples, straight lines between
// four of them. No weight is negative, so that nothing dark turns negative beside a spike.
#pragma once

#include <array>
#include <cstddef>

namespace contrejour {

// out[i] = above[i] + t (below[i] - above[i]).
void blend_rows(const float* above, const float* below, float t, std::size_t count, float* out);

// pixels[i] += scale[i % 3] * (samples[i] + t (samples[i + 3] - samples[i])): interleaved RGB.
void add_between(const float* samples, float t, const std::array<float, 3>& scale, std::size_t count, float* pixels);

}  // namespace contrejour
