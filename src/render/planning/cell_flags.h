// SPDX-License-Identifier: Apache-2.0
// A square grid of flags. Running sums of the flags along each row answer quickly whether a box contains a marked
// square.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

class CellFlags {
 public:
  CellFlags() = default;
  // The grid has side x side squares and covers the square from -extent to extent. mark(x, y) says whether the square
  // in column x and row y, counted from the lowest coordinates, is marked.
  template <class Mark>
  CellFlags(int side, double extent, const Mark& mark) : side_(side), extent_(extent) {
    for (int y = 0; y < side; ++y) {
      before_.push_back(0);
      for (int x = 0; x < side; ++x)
        before_.push_back(static_cast<std::uint16_t>(before_.back() + (mark(x, y) ? 1 : 0)));
    }
  }

  // The index of the square that contains a coordinate. Coordinates outside the grid give the outermost square, NaN
  // gives the first.
  [[nodiscard]] int cell_of(double coordinate) const {
    const double at = (coordinate + extent_) * 0.5 * side_ / extent_;
    return at > 0.0 ? static_cast<int>(std::min(at, side_ - 1.0)) : 0;
  }
  [[nodiscard]] bool any(int left, int right, int y) const {
    const std::uint16_t* const row =
        before_.data() + static_cast<std::size_t>(y) * (static_cast<std::size_t>(side_) + 1);
    return row[right + 1] != row[left];
  }
  [[nodiscard]] bool any_within(Vec2 low, Vec2 high) const {
    const int left = cell_of(low.x), right = cell_of(high.x), top = cell_of(high.y);
    for (int y = cell_of(low.y); y <= top; ++y)
      if (any(left, right, y)) return true;
    return false;
  }

 private:
  int side_ = 0;
  double extent_ = 1.0;
  std::vector<std::uint16_t> before_;  // the number of marked squares to the left of each border, row by row
};

}  // namespace contrejour::inline internal
