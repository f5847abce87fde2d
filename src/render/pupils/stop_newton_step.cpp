// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/stop_newton_step.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::pupils {
namespace {

constexpr double kStopMargin = 0.06;        // of the stop's radius
constexpr double kFarthest = 2.0;       // cells from the starting ray
constexpr double kThirdOrder = 1.0;     // assumed error of the second differences, over their contribution
constexpr double kLargestError = 0.75;  // with a larger error a box is no better than the grid
constexpr double kMinDeterminant = 1e-6;  // below it the Jacobian counts as folding
constexpr double kAgreement = 0.25;     // with rays that cross near the stop's rim, stop radii
constexpr double kNear = 2.0;           // stop radii

// The stop's coordinates as polynomials of second degree in cells from a ray of the grid.
struct Quadratic {
  Vec2 value, x, y, xx, xy, yy;  // xx, yy: halves of the second differences

  [[nodiscard]] Vec2 at(Vec2 p) const {
    return value + x * p.x + y * p.y + xx * (p.x * p.x) + xy * (p.x * p.y) + yy * (p.y * p.y);
  }
  [[nodiscard]] Vec2 along_x(Vec2 p) const { return x + xx * (2.0 * p.x) + xy * p.y; }
  [[nodiscard]] Vec2 along_y(Vec2 p) const { return y + yy * (2.0 * p.y) + xy * p.x; }
};

// A ray of the grid or, one row below the axis, the mirror image of one; none if it fails or lies outside.
std::optional<Vec2> crossing_at(const ClearanceGrid& grid, int crossing, int column, int row) {
  const bool mirrored = row < 0;
  if (mirrored) row = -row;
  if (column < 0 || column > grid.columns() || row > grid.rows() || (mirrored && !grid.touches_axis())) return {};
  const std::size_t ray = grid.at(column, row);
  if (grid.fails(ray)) return {};
  const Vec2 s = grid.stop(crossing, ray);
  return mirrored ? Vec2{s.x, -s.y} : s;
}

std::optional<Quadratic> differences(const ClearanceGrid& grid, int crossing, GridCell about) {
  std::array<Vec2, 9> s;
  for (int k = 0; k < 9; ++k) {
    const auto one = crossing_at(grid, crossing, about.column + k % 3 - 1, about.row + k / 3 - 1);
    if (!one) return {};
    s[static_cast<std::size_t>(k)] = *one;
  }
  return Quadratic{s[4],
                   (s[5] - s[3]) * 0.5,
                   (s[7] - s[1]) * 0.5,
                   (s[5] + s[3]) * 0.5 - s[4],
                   (s[8] + s[0] - s[2] - s[6]) * 0.25,
                   (s[7] + s[1]) * 0.5 - s[4]};
}

// The zero of the polynomials, by Newton's method from their origin.
std::optional<Vec2> zero_of(const Quadratic& q) {
  Vec2 p{0.0, 0.0};
  for (int step = 0; step < 5; ++step) {
    const Vec2 s = q.at(p);
    const Vec2 dx = q.along_x(p);
    const Vec2 dy = q.along_y(p);
    const double determinant = cross(dx, dy);
    if (!(std::abs(determinant) > kMinDeterminant * (dot(dx, dx) + dot(dy, dy)))) return {};
    p = p - Vec2{cross(s, dy), cross(dx, s)} * (1.0 / determinant);
    if (!(std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest)) return {};
  }
  return p;
}

// The ray of the cells that crosses closest to the middle of the stop, among rays with neighbours on all sides.
std::optional<GridCell> closest(const ClearanceGrid& grid, int crossing, const std::vector<GridCell>& piece) {
  std::optional<GridCell> best;
  double smallest = 0.0;
  for (const GridCell& cell : piece) {
    for (int k = 0; k < 4; ++k) {
      const GridCell node{std::clamp(cell.column + k % 2, 1, grid.columns() - 1),
                          std::clamp(cell.row + k / 2, grid.touches_axis() ? 0 : 1, grid.rows() - 1)};
      const auto s = crossing_at(grid, crossing, node.column, node.row);
      if (!s || (best && dot(*s, *s) >= smallest)) continue;
      best = node;
      smallest = dot(*s, *s);
    }
  }
  return best;
}

struct CellBox {
  Vec2 low, high;  // in columns and rows
  [[nodiscard]] bool holds_some_of(GridCell cell) const {
    return cell.column < high.x && cell.column + 1 > low.x && cell.row < high.y && cell.row + 1 > low.y;
  }
};

// True if rays near the stop's rim agree with the polynomials, and no other cell may cross the stop.
bool agrees(const ClearanceGrid& grid, int crossing, const std::vector<GridCell>& piece, const Quadratic& q,
            GridCell about, const CellBox& box) {
  for (const GridCell& cell : piece) {
    for (int k = 0; k < 4; ++k) {
      const int column = cell.column + k % 2;
      const int row = cell.row + k / 2;
      const auto s = crossing_at(grid, crossing, column, row);
      if (!s) continue;
      const Vec2 fit = q.at({static_cast<double>(column - about.column), static_cast<double>(row - about.row)});
      const bool near = std::min(dot(*s, *s), dot(fit, fit)) < kNear * kNear;
      if (near && length(*s - fit) > kAgreement) return false;
    }
    if (!box.holds_some_of(cell) && grid.may_transmit(cell, 0.0F)) return false;
  }
  return true;
}

std::optional<StopNewtonStep> newton_step_to_crossing(const ClearanceGrid& grid, int crossing,
                                                      const std::vector<GridCell>& piece) {
  const auto about = closest(grid, crossing, piece);
  if (!about) return {};
  const auto q = differences(grid, crossing, *about);
  if (!q) return {};
  const auto zero = zero_of(*q);
  if (!zero) return {};
  const Vec2 dx = q->along_x(*zero);
  const Vec2 dy = q->along_y(*zero);
  const double determinant = std::abs(cross(dx, dy));
  const Vec2 half{length(dy) / determinant, length(dx) / determinant};  // of the ellipse that maps to the stop's rim
  const auto curve = [&](Vec2 by) {
    return length(q->xx) * by.x * by.x + length(q->xy) * by.x * by.y + length(q->yy) * by.y * by.y;
  };
  const Vec2 away{std::abs(zero->x), std::abs(zero->y)};
  const double error = curve(half) + kThirdOrder * curve(away);
  if (!(error <= kLargestError)) return {};
  const Vec2 half_size = half * (1.0 + kStopMargin + error);
  const Vec2 middle{about->column + zero->x, about->row + zero->y};
  const CellBox cells{middle - half_size, middle + half_size};
  if (!agrees(grid, crossing, piece, *q, *about, cells)) return {};
  const Vec2 size = grid.cell_size();
  const auto point = [&](Vec2 p) { return grid.box().low + Vec2{p.x * size.x, p.y * size.y}; };
  return StopNewtonStep{{point(cells.low), point(cells.high)}, error};
}

}  // namespace

std::optional<StopNewtonStep> newton_step_to_stop(const ClearanceGrid& grid, const std::vector<GridCell>& piece) {
  std::optional<StopNewtonStep> all;
  for (int crossing = 0; crossing < grid.crossings(); ++crossing) {
    const auto one = newton_step_to_crossing(grid, crossing, piece);
    if (!one) continue;
    if (!all) {
      all = one;
      continue;
    }
    all->box.low = {std::max(all->box.low.x, one->box.low.x), std::max(all->box.low.y, one->box.low.y)};
    all->box.high = {std::min(all->box.high.x, one->box.high.x), std::min(all->box.high.y, one->box.high.y)};
    all->error = std::max(all->error, one->error);
  }
  return all;
}

}  // namespace contrejour::inline internal::pupils
