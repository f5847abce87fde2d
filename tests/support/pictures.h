// SPDX-License-Identifier: Apache-2.0
// Pictures as irises.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/iris_field.h"

namespace contrejour::test {

// A field from level(p) in 0..1 at the middles of a square picture's pixels, averaged over 3 x 3 points in each; p in
// stop radii.
template <class Level>
std::shared_ptr<const IrisField> drawn_field(int side, Level level) {
  std::vector<float> pixels;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      double sum = 0.0;
      for (int k = 0; k < 9; ++k) {
        const double x = column + (k % 3 + 0.5) / 3.0;
        const double y = row + (k / 3 + 0.5) / 3.0;
        sum += level(Vec2{2.0 * x / side - 1.0, 1.0 - 2.0 * y / side});
      }
      pixels.push_back(static_cast<float>(sum / 9.0));
    }
  }
  const auto field = IrisField::from_levels(pixels, side, side);
  REQUIRE(field.has_value());
  return *field;
}

// A flower with a hole within an open ring: neither convex nor connected, and different from all its mirror images.
inline bool is_in_flower(Vec2 p) {
  const double r = length(p);
  const double angle = std::atan2(p.y, p.x);
  const bool flower = r < 0.45 + 0.2 * std::cos(5.0 * angle) && length(p - Vec2{0.1, 0.15}) > 0.08;
  const bool ring = r > 0.75 && r < 0.92 && !(angle > 0.2 && angle < 0.9);
  return flower || ring;
}

inline std::shared_ptr<const IrisField> flower_field(int side = 300) { return drawn_field(side, is_in_flower); }

}  // namespace contrejour::test
