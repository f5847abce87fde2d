// SPDX-License-Identifier: Apache-2.0
// Rays on a uniform grid over a part of the upper half of the entrance plane, and their clearances: which cells may
// transmit light, and which of these are connected. It is in the light's meridional frame; the iris counts as its
// circumscribed circle.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "ghosts/ray_grid.h"
#include "render/pupils/clearance_rays.h"

namespace contrejour::inline internal::pupils {

struct GridCell {
  int column = 0, row = 0;
};

class ClearanceGrid {
 public:
  // path: from any point of the entrance plane.
  explicit ClearanceGrid(PacketPath path) : rays_(std::move(path)) {}
  explicit ClearanceGrid(std::shared_ptr<RaySource> source) : rays_(std::move(source)) {}

  // box: y >= 0.
  void trace(const Rectangle& box, int columns, int rows);

  [[nodiscard]] const Rectangle& box() const { return box_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int crossings() const { return rays_.crossings(); }
  [[nodiscard]] std::uint64_t rays() const { return rays_.rays(); }  // of all grids so far
  [[nodiscard]] std::size_t steps() const { return rays_.steps(); }
  [[nodiscard]] bool touches_axis() const { return box_.low.y == 0.0; }
  [[nodiscard]] Vec2 cell_size() const {
    return {(box_.high.x - box_.low.x) / columns_, (box_.high.y - box_.low.y) / rows_};
  }
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row * (columns_ + 1) + column);
  }
  [[nodiscard]] bool fails(std::size_t ray) const { return rays_.fails(ray); }
  // For two rays that fail: the extrapolated distance beyond the nearer one, over the distance of the two, at which
  // rays no longer fail; infinite if they do not determine it.
  [[nodiscard]] double arrives_after(std::size_t farther, std::size_t nearer) const;
  [[nodiscard]] bool is_open(std::size_t ray) const { return open_[ray] != 0; }
  // The squared relative height of a ray, at the stop or at its outermost rim, less 1; open below 0.
  [[nodiscard]] float excess(std::size_t ray) const;
  // Over the stop's radius.
  [[nodiscard]] Vec2 stop(int crossing, std::size_t ray) const {
    const auto [x, y] = rays_.in_circle(static_cast<std::size_t>(1 + crossing), ray);
    return {x, y};
  }

  // True if light may pass through a cell, provided that fields exceed their corner values by at most `margin` times
  // the corners' difference.
  [[nodiscard]] bool may_transmit(GridCell cell, float margin) const;
  [[nodiscard]] int open_corners(GridCell cell) const;

  // The connected components of cells that may transmit light; cells that touch at a corner are connected.
  [[nodiscard]] std::vector<std::vector<GridCell>> components(float margin) const;
  // The box enlarged by a fraction of its size on every side at which rays get through, within bounds.
  [[nodiscard]] Rectangle grown(double fraction, const Rectangle& bounds) const;

  [[nodiscard]] Rectangle hull(const std::vector<GridCell>& cells) const;

 private:
  // True if a point of the unit circle may be reached in a cell, by its x and y: ClearanceRays::in_circle.
  [[nodiscard]] bool may_meet_circle(std::size_t circle, const std::array<std::size_t, 4>& corners, float margin) const;
  void find_open();

  ClearanceRays rays_;
  Rectangle box_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> open_;
};

}  // namespace contrejour::inline internal::pupils
