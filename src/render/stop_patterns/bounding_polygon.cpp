// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/bounding_polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::stop_patterns {
namespace {

std::array<Vec2, BoundingPolygon::kLines> even_normals() {
  std::array<Vec2, BoundingPolygon::kLines> out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(out.size());
    out[k] = {std::cos(angle), std::sin(angle)};
  }
  return out;
}

}  // namespace

const std::array<Vec2, BoundingPolygon::kLines>& BoundingPolygon::normals() {
  static const auto all = even_normals();
  return all;
}

bool BoundingPolygon::excludes(Vec2 middle, double radius) const {
  const double outer_radius = nearest_ + radius;
  if (dot(middle, middle) <= outer_radius * outer_radius) return false;  // nearer than any line
  const auto& normal = normals();
  for (std::size_t k = 0; k < kLines; ++k)
    if (dot(normal[k], middle) - radius > distance_[k]) return true;
  return false;
}

void BoundingPolygon::include(Vec2 p) {
  const auto& normal = normals();
  for (std::size_t k = 0; k < kLines; ++k) distance_[k] = std::max(distance_[k], dot(normal[k], p));
  nearest_ = *std::min_element(distance_.begin(), distance_.end());
}

void BoundingPolygon::include(const BoundingPolygon& other, double times) {
  for (std::size_t k = 0; k < kLines; ++k) distance_[k] = std::max(distance_[k], times * other.distance_[k]);
  nearest_ = *std::min_element(distance_.begin(), distance_.end());
}

}  // namespace contrejour::inline internal::stop_patterns
