// SPDX-License-Identifier: Apache-2.0
// Decides through which cells of a grid of rays light may pass, from the values at their corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "ghosts/ray_grid.h"

namespace contrejour::inline internal::pupils {

// The lowest and highest value of a function at a cell's corners; the cell is open where the function is <= 0. The
// function is assumed nearly linear: it falls below its lowest corner by at most `margin` times the corners'
// difference.
class Extremes {
 public:
  void add(float value) {
    lowest_ = std::min(lowest_, value);
    highest_ = std::max(highest_, value);
  }
  [[nodiscard]] bool may_transmit(float margin) const {
    return lowest_ <= 0.0F || lowest_ <= margin * (highest_ - lowest_);
  }

 private:
  float lowest_ = std::numeric_limits<float>::infinity();
  float highest_ = -std::numeric_limits<float>::infinity();
};

// Whether light may pass through a cell, provided that no value falls below its lowest corner by more than the corners
// differ. A corner whose ray fails is ignored. stop_distance(crossing, vertex): distance from what the stop leaves
// open, at and below 0 inside.
template <class StopDistance>
[[nodiscard]] bool may_transmit(const RayGrid& grid, const std::array<std::size_t, 4>& corners,
                                const StopDistance& stop_distance) {
  constexpr float kReach = 1.0F;
  std::array<Extremes, 1 + kMaxStopCrossings> extremes;
  const auto crossings = static_cast<std::size_t>(grid.stop_crossings());
  bool any = false;
  for (const std::size_t k : corners) {
    if (grid.blocked[k] <= 0.0F) return true;
    if (grid.blocked[k] == kFailed) continue;
    any = true;
    extremes[0].add(grid.relative_height[k] - 1.0F);
    for (std::size_t c = 0; c < crossings; ++c) extremes[1 + c].add(stop_distance(c, k));
  }
  return any && std::all_of(extremes.begin(), extremes.begin() + 1 + static_cast<std::ptrdiff_t>(crossings),
                            [](const Extremes& e) { return e.may_transmit(kReach); });
}

// The bounds of the cells for which is_open(column, row, whether the cell is within the bounds so far) holds; empty if
// there is none.
template <class IsOpen>
[[nodiscard]] std::optional<Rectangle> bounds_of_cells(const RayGrid& grid, const IsOpen& is_open) {
  const int cells = grid.cells();
  int left = cells, right = 0, bottom = cells, top = 0;
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      if (!is_open(ix, iy, ix >= left && ix < right && iy >= bottom && iy < top)) continue;
      left = std::min(left, ix);
      right = std::max(right, ix + 1);
      bottom = std::min(bottom, iy);
      top = std::max(top, iy + 1);
    }
  }
  if (right == 0) return std::nullopt;
  const Vec2 step = grid.step_mm(), low = grid.box().low;
  return Rectangle{low + Vec2{left * step.x, bottom * step.y}, low + Vec2{right * step.x, top * step.y}};
}

}  // namespace contrejour::inline internal::pupils
