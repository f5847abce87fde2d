// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/fitted_pupil.h"

#include "render/pupils/clearance_grid.h"
#include "render/pupils/ghost_pupil.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kEvaluatedColumns = 8;  // of each grid; half as many rows in a box that touches the axis
constexpr float kEvaluatedMargin = 0.5F;  // ClearanceGrid::may_transmit
constexpr double kWorthLevel = 0.6;  // of the area
constexpr int kMaxLevels = 8;  // of grids, each in a part of the preceding one

// Adds the boxes of light in a part of the upper half.
void search_evaluated(ClearanceGrid& grid, const Rectangle& part, int level, std::vector<Rectangle>& boxes) {
  grid.trace(part, kEvaluatedColumns, part.low.y == 0.0 ? kEvaluatedColumns / 2 : kEvaluatedColumns);
  std::vector<Rectangle> hulls;
  for (const std::vector<GridCell>& piece : grid.components(kEvaluatedMargin)) hulls.push_back(grid.hull(piece));
  for (const Rectangle& hull : hulls) {
    if (level < kMaxLevels && area_of(hull) < kWorthLevel * area_of(part))
      search_evaluated(grid, hull, level + 1, boxes);
    else
      boxes.push_back(hull);
  }
}

}  // namespace

std::vector<Rectangle> find_fitted_pupil(const FittedGhost& ghost, std::span<const double> lambda_nm) {
  const Rectangle half = ghost.upper_half();
  if (!(half.low.x < half.high.x && half.low.y < half.high.y)) return {};
  std::vector<Rectangle> found;
  for (const double at_nm : {lambda_nm.front(), lambda_nm.back()}) {
    ClearanceGrid grid(ghost.at(at_nm));
    search_evaluated(grid, half, 0, found);
    if (lambda_nm.size() == 1) break;
  }
  for (Rectangle& box : found)
    if (box.low.y == 0.0) box.low.y = -box.high.y;
  found = disjoint(std::move(found));
  std::vector<Rectangle> boxes;
  for (const Rectangle& box : found) {
    boxes.push_back(box);
    if (box.low.y >= 0.0) boxes.push_back(mirrored(box));
  }
  return boxes;
}

}  // namespace contrejour::inline internal::pupils
