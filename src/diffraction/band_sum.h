// SPDX-License-Identifier: Apache-2.0
// The inner loop of make_starburst: each channel's weighted sum over the rows of all wavelengths.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace contrejour::inline internal {

constexpr std::size_t kDirectionsAtOnce = 16;  // the widest vector of floats

// sum[c][a] = sum over k of weights[k][c] * last_row[-k * kDirectionsAtOnce + a].
using DirectionSums = std::array<std::array<float, kDirectionsAtOnce>, 3>;
void sum_bands(std::span<const std::array<float, 3>> weights, const float* last_row, DirectionSums& sum);

}  // namespace contrejour::inline internal
