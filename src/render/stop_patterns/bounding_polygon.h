// SPDX-License-Identifier: Apache-2.0
// A bounding polygon of the visible part of a pattern. All polygons have the same directions, so that those of several
// wavelengths are combined by taking the larger distances. Units: stop radii.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::stop_patterns {

class BoundingPolygon {
 public:
  static constexpr std::size_t kLines = 24;

  // The outward normals, evenly spaced, the first one to the right.
  [[nodiscard]] static const std::array<Vec2, kLines>& normals();

  [[nodiscard]] double distance(std::size_t line) const { return distance_[line]; }  // largest dot(normals()[line], p)
  [[nodiscard]] bool excludes(Vec2 middle, double radius) const;  // a disc that lies beyond one of the lines

  void include(Vec2 p);
  void include(const BoundingPolygon& other, double times = 1.0);  // scaled by `times` >= 0

 private:
  std::array<double, kLines> distance_{};
  double nearest_ = 0.0;  // smallest of them
};

}  // namespace contrejour::inline internal::stop_patterns
