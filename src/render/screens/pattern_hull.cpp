#include "render/screens/pattern_hull.h"

#include <cmath>
#include <numbers>

namespace contrejour::screens {
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
  const auto& normal = normals();
  for (std::size_t k = 0; k < kLines; ++k)
    if (dot(normal[k], middle) - radius > most_[k]) return true;
  return false;
}

void PatternHull::hold(Vec2 p) {
  const auto& normal = normals();
  for (std::size_t k = 0; k < kLines; ++k) most_[k] = std::max(most_[k], dot(normal[k], p));
}

void PatternHull::hold(const PatternHull& other) {
  for (std::size_t k = 0; k < kLines; ++k) most_[k] = std::max(most_[k], other.most_[k]);
}

}  // namespace contrejour::screens
