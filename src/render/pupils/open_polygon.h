// SPDX-License-Identifier: Apache-2.0
// The open part of a triangle of rays between which the excess over what blocks them is linear: its area, its moments,
// and the border that divides it. All change continuously with the excesses.
#pragma once

#include <array>

#include "base/linear_map.h"

namespace contrejour::inline internal::pupils {

// Integrals over an area of the plane.
struct AreaMoments {
  double area_mm2 = 0.0;
  Vec2 first;                     // of the position
  LinearMap second = kZeroMap;    // of the position's outer product with itself

  [[nodiscard]] Vec2 centroid() const { return first * (1.0 / area_mm2); }
  [[nodiscard]] LinearMap covariance() const {
    const Vec2 mean = centroid();
    return second * (1.0 / area_mm2) - LinearMap{mean * mean.x, mean * mean.y};
  }
  void add(const AreaMoments& other, double weight) {
    area_mm2 += weight * other.area_mm2;
    first = first + other.first * weight;
    second = second + other.second * weight;
  }
};

struct OpenPolygon {
  AreaMoments moments;
  bool has_border = false;
  std::array<Vec2, 2> border{};  // ends of the line at which the excess is 0
};

// outside: a vertex is open if its excess is 0 or less.
[[nodiscard]] OpenPolygon open_polygon(const std::array<Vec2, 3>& at, const std::array<double, 3>& outside);

}  // namespace contrejour::inline internal::pupils
