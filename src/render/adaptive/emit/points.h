// SPDX-License-Identifier: Apache-2.0
// The corners of polygons as the points that a polygon list takes.
#pragma once

#include <span>
#include <vector>

#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

class PointBuffer {
 public:
  // Valid until the next call.
  template <class AnyCorner>
  [[nodiscard]] std::span<const Point> points_of(std::span<const AnyCorner> polygon) {
    points_.clear();
    for (const AnyCorner& c : polygon)
      points_.push_back({static_cast<float>(c.position.x), static_cast<float>(c.position.y)});
    return points_;
  }

 private:
  std::vector<Point> points_;
};

}  // namespace contrejour::inline internal::adaptive
