// SPDX-License-Identifier: Apache-2.0
// The part of a grid of rays that gets through: halves of its cells, with the open fraction of each.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "ghosts/ray_grid.h"

namespace contrejour::inline internal {

// Half a cell of the grid: its vertices, the fraction of its area that is open, and the flux through that.
struct OpenTriangle {
  std::array<std::size_t, 3> vertex;
  double open = 0;
  double flux_mm2 = 0;  // without LightSource::shared_flux()
};

// The fraction of a triangle where a function that is linear over it is <= 0.
[[nodiscard]] inline double fraction_below_zero(double a, double b, double c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  if (c <= 0.0) return 1.0;
  if (a > 0.0) return 0.0;
  if (b > 0.0) return a / (a - b) * (a / (a - c));  // the corner at a
  return 1.0 - c / (c - a) * (c / (c - b));         // all but the corner at c
}

// Visits the two halves of a cell, given by its vertices in order.
template <class Visit>
void for_each_open_half(const RayGrid& grid, const std::array<std::size_t, 4>& q, const Visit& visit) {
  const Vec2 step = grid.step_mm();
  for (const auto& v : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
    const auto blocked = [&](std::size_t k) { return grid.blocked[v[k]]; };
    if (!(blocked(0) < kFailed && blocked(1) < kFailed && blocked(2) < kFailed)) continue;
    const double open = fraction_below_zero(blocked(0), blocked(1), blocked(2));
    if (open <= 0.0) continue;
    const double transmission = (grid.transmission[v[0]] + grid.transmission[v[1]] + grid.transmission[v[2]]) / 3.0;
    visit(OpenTriangle{v, open, open * transmission * 0.5 * step.x * step.y});
  }
}

}  // namespace contrejour::inline internal
