// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/open_polygon.h"

#include <cmath>
#include <cstddef>

namespace contrejour::inline internal::pupils {
namespace {

LinearMap outer(Vec2 v) { return {v * v.x, v * v.y}; }

// The second moment is exact for a triangle: a twelfth of the vertices' squares and of the square of their sum.
AreaMoments moments_of(Vec2 a, Vec2 b, Vec2 c) {
  const double area = 0.5 * std::abs(cross(b - a, c - a));
  const Vec2 sum = a + b + c;
  return {area, sum * (area / 3.0), (outer(a) + outer(b) + outer(c) + outer(sum)) * (area / 12.0)};
}

}  // namespace

OpenPolygon open_polygon(const std::array<Vec2, 3>& at, const std::array<double, 3>& outside) {
  OpenPolygon part;
  std::array<Vec2, 4> polygon;
  std::size_t corners = 0, crossings = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const bool is_open = outside[k] <= 0.0;
    if (is_open) polygon[corners++] = at[k];
    if (is_open == (outside[next] <= 0.0)) continue;
    const Vec2 crossing = at[k] + (at[next] - at[k]) * (outside[k] / (outside[k] - outside[next]));
    polygon[corners++] = crossing;
    part.border[crossings++] = crossing;
  }
  part.has_border = crossings == 2;
  for (std::size_t k = 2; k < corners; ++k) part.moments.add(moments_of(polygon[0], polygon[k - 1], polygon[k]), 1.0);
  return part;
}

}  // namespace contrejour::inline internal::pupils
