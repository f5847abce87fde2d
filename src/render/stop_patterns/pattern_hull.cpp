// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/pattern_hull.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::stop_patterns {
namespace {

std::array<Vec2, PatternHull::kLines> even_normals() {
  std::array<Vec2, PatternHull::kLines> out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(out.size());
    out[k] = {std::cos(angle), std::sin(angle)};
  }
  return out;
}

}  // namespace

const std::array<Vec2, PatternHull::kLines>& PatternHull::normals() {
  static const auto all = even_normals();
  return all;
}

bool PatternHull::misses(Vec2 middle, double radius) const {
  const double reach = nearest_ + radius;
  if (dot(middle, middle) <= reach * reach) return false;  // nearer than any line
  const auto& normal = normals();
  for (std::size_t k = 0; k < kLines; ++k)
    if (dot(normal[k], middle) - radius > most_[k]) return true;
  return false;
}

void PatternHull::hold(Vec2 p) {
  const auto& normal = normals();
  for (std::size_t k = 0; k < kLines; ++k) most_[k] = std::max(most_[k], dot(normal[k], p));
  nearest_ = *std::min_element(most_.begin(), most_.end());
}

void PatternHull::hold(const PatternHull& other, double times) {
  for (std::size_t k = 0; k < kLines; ++k) most_[k] = std::max(most_[k], times * other.most_[k]);
  nearest_ = *std::min_element(most_.begin(), most_.end());
}

}  // namespace contrejour::inline internal::stop_patterns
