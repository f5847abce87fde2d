// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/mask_points.h"

#include <algorithm>

namespace contrejour::inline internal {

SmoothFit fit_points(std::span<const Vec2> from, std::span<const Vec2> to, int degree) {
  std::vector<double> values;
  for (const Vec2 p : to) values.push_back(p.x);
  for (const Vec2 p : to) values.push_back(p.y);
  return {from, values, degree};
}

MaskPoints::MaskPoints(std::span<const Vec2> cosines, std::span<const Vec2> points, int degree, Vec2 middle,
                       const MaskGrid& grid)
    : knots_(grid.side / kKnotStep + 2) {
  const SmoothFit fit = fit_points(cosines, points, degree);
  const auto [left, right] = std::ranges::minmax(cosines, {}, &Vec2::x);
  const auto [down, up] = std::ranges::minmax(cosines, {}, &Vec2::y);
  for (int row = 0; row < knots_; ++row) {
    for (int column = 0; column < knots_; ++column) {
      const Vec2 from = middle + grid.position_mm(column * kKnotStep, row * kKnotStep);
      double point[2];
      fit.evaluate({std::clamp(from.x, left.x, right.x), std::clamp(from.y, down.y, up.y)}, point);
      at_knot_.push_back({point[0], point[1]});
    }
  }
}

Vec2 MaskPoints::at(double column, double row) const {
  const double x = column / kKnotStep, y = row / kKnotStep;
  const int i = std::clamp(static_cast<int>(x), 0, knots_ - 2), j = std::clamp(static_cast<int>(y), 0, knots_ - 2);
  const double s = x - i, t = y - j;
  const Vec2* const p = at_knot_.data() + j * knots_ + i;
  return (p[0] * (1.0 - s) + p[1] * s) * (1.0 - t) + (p[knots_] * (1.0 - s) + p[knots_ + 1] * s) * t;
}

double MaskPoints::sample() const {
  const std::size_t middle = static_cast<std::size_t>(knots_ / 2) * static_cast<std::size_t>(knots_ + 1);
  return length(at_knot_[middle] - at_knot_[middle - 1]) / kKnotStep;
}

}  // namespace contrejour::inline internal
