// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/fitted_pupil.h"

#include "render/pupils/clearance_grid.h"
#include "render/pupils/ghost_pupil.h"

namespace contrejour::inline internal::pupils {
namespace {

// The sides of the first grid and of the others; half as many rows in a box that touches the axis. The first one is
// fine, since a fit far outside the light may take any values, which coarse cells would join with those of the light.
constexpr int kFirstEvaluatedColumns = 24, kEvaluatedColumns = 8;
constexpr float kEvaluatedMargin = 0.5F;  // ClearanceGrid::may_transmit
constexpr double kWorthLevel = 0.6;  // of the area
constexpr int kMaxDarkGrids = 3;  // in a row, without a ray that gets through
constexpr int kMaxLevels = 8;  // of grids, each in a part of the preceding one

// A connected piece of a grid that may transmit light.
struct LitPiece {
  Rectangle hull;
  bool is_open = false;  // a ray of it gets through
};

std::vector<LitPiece> pieces_of(const ClearanceGrid& grid) {
  std::vector<LitPiece> pieces;
  for (const std::vector<GridCell>& piece : grid.components(kEvaluatedMargin)) {
    LitPiece lit{grid.hull(piece)};
    for (const GridCell& cell : piece) lit.is_open = lit.is_open || grid.open_corners(cell) > 0;
    pieces.push_back(lit);
  }
  return pieces;
}

// Adds the boxes of light in a part of the region. dark: grids since one had a ray that gets through.
void search_evaluated(ClearanceGrid& grid, const Rectangle& part, int level, int dark, std::vector<Rectangle>& boxes) {
  const int columns = level == 0 ? kFirstEvaluatedColumns : kEvaluatedColumns;
  grid.trace(part, columns, part.low.y == 0.0 ? columns / 2 : columns);
  for (const LitPiece& piece : pieces_of(grid)) {
    const int dark_here = piece.is_open ? 0 : dark + 1;
    const bool shrinks = area_of(piece.hull) < kWorthLevel * area_of(part);
    if (level < kMaxLevels && dark_here < kMaxDarkGrids && (shrinks || dark_here > 0))
      search_evaluated(grid, piece.hull, level + 1, dark_here, boxes);
    else if (dark_here == 0)
      boxes.push_back(piece.hull);
  }
}

}  // namespace

std::vector<Rectangle> find_fitted_pupil(const FittedGhost& ghost, std::span<const double> lambda_nm) {
  const Rectangle region = ghost.region();
  if (!(region.low.x < region.high.x && region.low.y < region.high.y)) return {};
  std::vector<Rectangle> found;
  for (const double at_nm : {lambda_nm.front(), lambda_nm.back()}) {
    ClearanceGrid grid(ghost.at(at_nm));
    search_evaluated(grid, region, 0, 0, found);
    if (lambda_nm.size() == 1) break;
  }
  if (!ghost.is_symmetric()) return disjoint(std::move(found));
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
