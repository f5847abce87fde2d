// SPDX-License-Identifier: Apache-2.0
// Small functions of one number that several layers need.
// Thread-safety: pure functions.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numbers>

namespace contrejour::inline internal {

inline constexpr double kPi = std::numbers::pi;

[[nodiscard]] constexpr double square(double x) { return x * x; }

// The range includes low and high; NaN is never within.
[[nodiscard]] constexpr bool within(double value, double low, double high) { return value >= low && value <= high; }

// 0 up to x = 0, 1 from x = 1 on, and between them the cubic whose slope is 0 at both.
[[nodiscard]] constexpr double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// Unlike ==, this distinguishes -0 from 0, and a NaN equals itself.
[[nodiscard]] constexpr bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace contrejour::inline internal
