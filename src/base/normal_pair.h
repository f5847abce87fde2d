// SPDX-License-Identifier: Apache-2.0
// Seeded random offsets in a plane.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <random>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

// Two independent normal numbers whose mean squared length is 1, a function of these words alone. Box and Muller 1958.
inline Vec2 normal_pair(std::initializer_list<std::uint32_t> words) {
  std::seed_seq mixed(words);
  std::mt19937 random(mixed);
  const auto next = [&] { return (static_cast<double>(random()) + 0.5) * 0x1p-32; };  // in (0, 1)
  const double radius = std::sqrt(-std::log(next()));
  const double angle_rad = 2.0 * std::numbers::pi * next();
  return {radius * std::cos(angle_rad), radius * std::sin(angle_rad)};
}

}  // namespace contrejour::inline internal
