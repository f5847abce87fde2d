// SPDX-License-Identifier: Apache-2.0
// Linear maps of the plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

struct LinearMap {
  Vec2 x{1.0, 0.0}, y{0.0, 1.0};  // images of the unit vectors

  [[nodiscard]] Vec2 operator()(Vec2 v) const { return x * v.x + y * v.y; }
  [[nodiscard]] double determinant() const { return cross(x, y); }
};

inline constexpr LinearMap kZeroMap{{0.0, 0.0}, {0.0, 0.0}};  // maps everything to one point

// Applies b, then a.
inline LinearMap operator*(const LinearMap& a, const LinearMap& b) { return {a(b.x), a(b.y)}; }
inline LinearMap operator+(const LinearMap& a, const LinearMap& b) { return {a.x + b.x, a.y + b.y}; }
inline LinearMap operator-(const LinearMap& a, const LinearMap& b) { return {a.x - b.x, a.y - b.y}; }
inline LinearMap operator*(const LinearMap& a, double s) { return {a.x * s, a.y * s}; }

inline LinearMap transposed(const LinearMap& a) { return {{a.x.x, a.y.x}, {a.x.y, a.y.y}}; }

// The determinant of the map must not be zero.
inline LinearMap inverse(const LinearMap& a) {
  const double s = 1.0 / a.determinant();
  return {{a.y.y * s, -a.x.y * s}, {-a.y.x * s, a.x.x * s}};
}

// The eigenvalues of a symmetric map, the smaller one first.
inline Vec2 eigenvalues(const LinearMap& a) {
  const double mean = 0.5 * (a.x.x + a.y.y), half_difference = std::hypot(0.5 * (a.x.x - a.y.y), a.x.y);
  return {mean - half_difference, mean + half_difference};
}

// The symmetric square root of a symmetric map without negative eigenvalues (Cayley-Hamilton).
inline LinearMap square_root(const LinearMap& a) {
  const Vec2 e = eigenvalues(a);
  const double low = std::sqrt(std::max(e.x, 0.0)), high = std::sqrt(std::max(e.y, 0.0));
  if (!(low + high > 0.0)) return kZeroMap;
  return (a + LinearMap{} * (low * high)) * (1.0 / (low + high));
}

// The covariance of points with the given covariance after a linear map.
inline LinearMap mapped_covariance(const LinearMap& map, const LinearMap& covariance) {
  return map * covariance * transposed(map);
}

// The component of the map's displacement along a direction, for each of its two variables.
inline Vec2 along(Vec2 direction, const LinearMap& map) { return {dot(direction, map.x), dot(direction, map.y)}; }

inline double trace_of(const LinearMap& a) { return a.x.x + a.y.y; }

}  // namespace contrejour::inline internal
