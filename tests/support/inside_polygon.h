// SPDX-License-Identifier: Apache-2.0
// Tests whether a point is inside a polygon, by counting crossings.
#pragma once

#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::test {

inline bool inside_polygon(const std::vector<Vec2>& polygon, Vec2 p) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

}  // namespace contrejour::test
