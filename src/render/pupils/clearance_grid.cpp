// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/clearance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal::pupils {
namespace {

struct Range {
  float low, high;
};

// The range of a field over the corners of a cell, extended at both ends by `margin` times their difference.
Range range_of(const float* field, const std::array<std::size_t, 4>& corners, float margin) {
  const float a = field[corners[0]];
  const float b = field[corners[1]];
  const float c = field[corners[2]];
  const float d = field[corners[3]];
  const float low = std::min(std::min(a, b), std::min(c, d));
  const float high = std::max(std::max(a, b), std::max(c, d));
  const float more = margin * (high - low);
  return {low - more, high + more};
}

float distance_to_zero(Range r) { return std::max(0.0F, std::max(r.low, -r.high)); }

}  // namespace

void ClearanceGrid::trace(const Rectangle& box, int columns, int rows) {
  box_ = box;
  columns_ = columns;
  rows_ = rows;
  const Vec2 size = cell_size();
  const std::size_t count = static_cast<std::size_t>(columns + 1) * static_cast<std::size_t>(rows + 1);
  rays_.resize(count);
  const std::span<float> x_mm = rays_.x_mm(), y_mm = rays_.y_mm();
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      x_mm[at(column, row)] = static_cast<float>(column * size.x);
      y_mm[at(column, row)] = static_cast<float>(row * size.y);
    }
  }
  rays_.trace(box.low, search_precision(std::min(size.x, size.y)));
  find_open();
}

void ClearanceGrid::find_open() {
  const std::size_t count = rays_.count();
  open_.resize(count);
  const float* failing = rays_.field(ClearanceRays::kFailing);
  for (std::size_t k = 0; k < count; ++k) open_[k] = failing[k] == 0.0F ? 1 : 0;
  const auto circles = static_cast<std::size_t>(1 + crossings());
  for (std::size_t c = 0; c < circles; ++c) {
    const float* x = rays_.field(ClearanceRays::kRim + 2 * c);
    const float* y = rays_.field(ClearanceRays::kRim + 2 * c + 1);
    for (std::size_t k = 0; k < count; ++k) {
      if (!(x[k] * x[k] + y[k] * y[k] <= 1.0F)) open_[k] = 0;
    }
  }
}

double ClearanceGrid::arrives_after(std::size_t farther, std::size_t nearer) const {
  const float* const failing = rays_.field(ClearanceRays::kFailing);
  const float* const passed = rays_.field(ClearanceRays::kPassed);
  const double change = static_cast<double>(failing[nearer]) - failing[farther];
  if (passed[farther] != passed[nearer] || !(change > 0.0)) return std::numeric_limits<double>::infinity();
  return -failing[nearer] / change;
}

float ClearanceGrid::excess(std::size_t ray) const {
  float largest = 0.0F;
  for (std::size_t c = 0; c <= static_cast<std::size_t>(crossings()); ++c) {
    const auto [x, y] = rays_.in_circle(c, ray);
    largest = std::max(largest, x * x + y * y);
  }
  return largest - 1.0F;
}

bool ClearanceGrid::may_meet_circle(std::size_t circle, const std::array<std::size_t, 4>& corners, float margin) const {
  const std::size_t k = ClearanceRays::kRim + 2 * circle;
  const float x = distance_to_zero(range_of(rays_.field(k), corners, margin));
  const float y = distance_to_zero(range_of(rays_.field(k + 1), corners, margin));
  return x * x + y * y <= 1.0F;
}

bool ClearanceGrid::may_transmit(GridCell cell, float margin) const {
  std::array<std::size_t, 4> corners{at(cell.column, cell.row), at(cell.column + 1, cell.row),
                                     at(cell.column, cell.row + 1), at(cell.column + 1, cell.row + 1)};
  // A ray that fails is ignored: the others decide.
  const auto known = [&](std::size_t ray) { return !fails(ray); };
  const auto one = std::find_if(corners.begin(), corners.end(), known);
  if (one == corners.end()) return false;
  std::replace_if(corners.begin(), corners.end(), [&](std::size_t ray) { return !known(ray); }, std::size_t{*one});
  for (int c = 0; c <= crossings(); ++c) {
    if (!may_meet_circle(static_cast<std::size_t>(c), corners, margin)) return false;
  }
  return true;
}

int ClearanceGrid::open_corners(GridCell cell) const {
  return open_[at(cell.column, cell.row)] + open_[at(cell.column + 1, cell.row)] +
         open_[at(cell.column, cell.row + 1)] + open_[at(cell.column + 1, cell.row + 1)];
}

std::vector<std::vector<GridCell>> ClearanceGrid::components(float margin) const {
  const auto index = [&](int column, int row) { return static_cast<std::size_t>(row * columns_ + column); };
  std::vector<std::uint8_t> left(static_cast<std::size_t>(columns_ * rows_));
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      left[index(column, row)] = may_transmit({column, row}, margin) ? 1 : 0;
    }
  }
  std::vector<std::vector<GridCell>> out;
  for (int k = 0; k < columns_ * rows_; ++k) {
    if (left[static_cast<std::size_t>(k)] == 0) continue;
    left[static_cast<std::size_t>(k)] = 0;
    std::vector<GridCell> piece{{k % columns_, k / columns_}};
    for (std::size_t next = 0; next < piece.size(); ++next) {
      const GridCell cell = piece[next];
      for (int row = std::max(cell.row - 1, 0); row <= std::min(cell.row + 1, rows_ - 1); ++row) {
        for (int column = std::max(cell.column - 1, 0); column <= std::min(cell.column + 1, columns_ - 1); ++column) {
          if (left[index(column, row)] == 0) continue;
          left[index(column, row)] = 0;
          piece.push_back({column, row});
        }
      }
    }
    out.push_back(std::move(piece));
  }
  return out;
}

Rectangle ClearanceGrid::grown(double fraction, const Rectangle& bounds) const {
  bool left = false, right = false, below = false, above = false;
  for (int row = 0; row <= rows_; ++row) {
    left = left || is_open(at(0, row));
    right = right || is_open(at(columns_, row));
  }
  for (int column = 0; column <= columns_; ++column) {
    below = below || is_open(at(column, 0));
    above = above || is_open(at(column, rows_));
  }
  const Vec2 more = (box_.high - box_.low) * fraction;
  Rectangle out = box_;
  if (left) out.low.x = std::min(box_.low.x, std::max(box_.low.x - more.x, bounds.low.x));
  if (right) out.high.x = std::max(box_.high.x, std::min(box_.high.x + more.x, bounds.high.x));
  if (below) out.low.y = std::min(box_.low.y, std::max(box_.low.y - more.y, bounds.low.y));
  if (above) out.high.y = std::max(box_.high.y, std::min(box_.high.y + more.y, bounds.high.y));
  return out;
}

Rectangle ClearanceGrid::hull(const std::vector<GridCell>& cells) const {
  GridCell low = cells.front();
  GridCell high = low;
  for (const GridCell& c : cells) {
    low = {std::min(low.column, c.column), std::min(low.row, c.row)};
    high = {std::max(high.column, c.column), std::max(high.row, c.row)};
  }
  const Vec2 size = cell_size();
  return {{box_.low.x + low.column * size.x, box_.low.y + low.row * size.y},
          {box_.low.x + (high.column + 1) * size.x, box_.low.y + (high.row + 1) * size.y}};
}

}  // namespace contrejour::inline internal::pupils
