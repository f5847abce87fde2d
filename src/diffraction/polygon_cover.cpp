// SPDX-License-Identifier: Apache-2.0
#include "diffraction/polygon_cover.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {

PolygonCover::PolygonCover(int side)
    : side_(side), width_(static_cast<std::size_t>(side) + 2), change_(static_cast<std::size_t>(side) * width_),
      touched_(static_cast<std::size_t>(side)), first_row_(side) {}

void PolygonCover::add(int row, int column, double area) {
  Touched& touched = touched_[static_cast<std::size_t>(row)];
  touched.first = std::min(touched.first, column);
  touched.last = std::max(touched.last, column);
  change_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column)] += area;
}

void PolygonCover::add_edge(Vec2 a, Vec2 b) {
  if (!(a.y != b.y) || !std::isfinite(a.x + a.y + b.x + b.y)) return;
  const double low = std::clamp(std::min(a.y, b.y), 0.0, static_cast<double>(side_));
  const double high = std::clamp(std::max(a.y, b.y), 0.0, static_cast<double>(side_));
  const auto at = [&](double y) { return Vec2{a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)), y}; };
  for (int row = static_cast<int>(low); row < side_ && row < high; ++row) {
    const Vec2 upper = at(std::max(low, static_cast<double>(row)));
    const Vec2 lower = at(std::min(high, row + 1.0));
    first_row_ = std::min(first_row_, row);
    last_row_ = std::max(last_row_, row);
    if (a.y < b.y)
      add_in_row(row, upper, lower);
    else
      add_in_row(row, lower, upper);
  }
}

// An edge to the left of the grid counts with its whole height from the first sample on; one to the right does not
// count.
void PolygonCover::add_in_row(int row, Vec2 a, Vec2 b) {
  const double right = side_;
  const double height = a.y - b.y;  // y points down: a counter-clockwise polygon has a positive area
  const double low = std::min(a.x, b.x), high = std::max(a.x, b.x);
  if (low >= right) return add(row, side_, 0.0);
  if (high <= 0.0) return add(row, 0, height);
  const double width = high - low;
  if (low < 0.0) add(row, 0, height * (-low / width));
  const int last = static_cast<int>(std::min(high, right - 1e-9));
  if (high > right) add(row, side_, 0.0);  // the area between the edges extends to the last sample
  for (int column = static_cast<int>(std::max(low, 0.0)); column <= last; ++column) {
    const double from = std::max({low, 0.0, static_cast<double>(column)});
    const double to = std::min({high, right, column + 1.0});
    const double part = width > 0.0 ? height * ((to - from) / width) : height;
    // The edge's mean distance from the sample's right side is the covered part of this sample; the rest counts from
    // the next.
    const double covered = column + 1.0 - 0.5 * (width > 0.0 ? from + to : 2.0 * low);
    add(row, column, part * covered);
    add(row, column + 1, part * (1.0 - covered));
  }
}

}  // namespace contrejour::inline internal
