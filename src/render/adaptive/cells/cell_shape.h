// SPDX-License-Identifier: Apache-2.0
// Bounds, areas and centroids of polygons of cells, and quadrature weights.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::adaptive {

// Simpson's weights along one axis: beginning, middle, end.
constexpr std::array kSimpson{1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};

struct Bounds {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  [[nodiscard]] Vec2 size() const { return high - low; }
};

// The signed area of a polygon, and its centroid.
struct Area {
  double signed_px = 0;
  Vec2 centroid;
};

template <class PositionOf>
[[nodiscard]] Area area_of(std::size_t count, PositionOf position) {
  Area out;
  Vec2 moment;
  const Vec2 origin = position(std::size_t{0});
  Vec2 before = position(std::size_t{1}) - origin;
  for (std::size_t k = 2; k < count; ++k) {
    const Vec2 next = position(k) - origin;
    const double part = 0.5 * cross(before, next);
    out.signed_px += part;
    moment = moment + (before + next) * (part / 3.0);
    before = next;
  }
  out.centroid = out.signed_px != 0.0 ? origin + moment * (1.0 / out.signed_px) : origin;
  return out;
}

}  // namespace contrejour::inline internal::adaptive
