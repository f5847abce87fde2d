// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/choose/visible_cell.h"

#include <algorithm>
#include <cstdint>

#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/stop_crossings.h"

namespace contrejour::inline internal::adaptive {
namespace {

Cell cell_at(const BoxMesh& of, const MeshSquare& square) {
  const auto [ix, iy, size] = square;
  Cell cell{.ix = ix, .iy = iy, .size = size};
  const int half = size / 2;
  cell.corner = {Mesh::at(ix, iy), Mesh::at(ix + size, iy), Mesh::at(ix + size, iy + size), Mesh::at(ix, iy + size)};
  cell.side = {Mesh::at(ix + half, iy), Mesh::at(ix + size, iy + half), Mesh::at(ix + half, iy + size),
               Mesh::at(ix, iy + half)};
  cell.middle = Mesh::at(ix + half, iy + half);
  const MeshPosition& at = of.position;
  const int x = at.x + ix * at.step, y = at.y + iy * at.step, length = size * at.step;
  cell.shared = {y > 0, x + length < MeshPosition::kWhole, y + length < MeshPosition::kWhole, x > 0};
  return cell;
}

// Returns whether a straight line separates all of the cell's crossings of the stop from its rim. Crossings that are
// all outside the stop may still surround it.
bool misses_stop(const Mesh& mesh, const Cell& cell, int crossing) {
  const Mesh::Field& x = mesh.field(PatchLayout::kStop + 2 * crossing);
  const Mesh::Field& y = mesh.field(PatchLayout::kStop + 2 * crossing + 1);
  const Vec2 middle{x[cell.middle], y[cell.middle]};
  const double distance = length(middle);
  const auto beyond = [&](std::size_t v) { return dot(middle, Vec2{x[v], y[v]}) > distance; };
  return beyond(cell.middle) && std::all_of(cell.corner.begin(), cell.corner.end(), beyond) &&
         std::all_of(cell.side.begin(), cell.side.end(), beyond);
}

// A cell is closed for certain only where a single rim or a single crossing of the iris blocks all of it. A stop
// pattern clips nothing: beyond its light the cell is dark.
CellState state_of(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  std::uint32_t any = 0;
  std::uint32_t all = ~0U;
  for (int y = cell.iy; y <= cell.iy + cell.size; ++y) {
    for (int x = cell.ix; x <= cell.ix + cell.size; ++x) {
      any |= mesh.outside[Mesh::at(x, y)];
      all &= mesh.outside[Mesh::at(x, y)];
    }
  }
  all &= ~Mesh::kNearObscuration;
  if ((band.pattern ? any >> mesh.layout.crossings : any) == 0) return CellState::Open;
  if (all >> mesh.layout.crossings != 0) return CellState::Blocked;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    if ((all >> c & 1U) != 0 && misses_stop(mesh, cell, c)) return CellState::Blocked;
  }
  return CellState::Clipped;
}

bool off_frame(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  Bounds b;
  for (const std::size_t v : cell.corner) b.add(mesh.position(v));
  for (const std::size_t v : cell.side) b.add(mesh.position(v));
  const Vec2 low = b.low + mesh.origin_px;
  const Vec2 high = b.high + mesh.origin_px;
  return !(high.x > 0.0 && high.y > 0.0 && low.x < band.width && low.y < band.height);
}

}  // namespace

std::optional<Cell> visible_cell(const BandContext& band, const BoxMesh& of, const MeshSquare& square) {
  const Mesh& mesh = of.mesh;
  Cell cell = cell_at(of, square);
  cell.state = state_of(band, mesh, cell);
  if (cell.state == CellState::Blocked || off_frame(band, mesh, cell)) return std::nullopt;
  cell.pattern = view_of_pattern(band, mesh, cell);
  if (cell.pattern.part == PatternRegion::Dark || (band.pattern && is_dim(band, mesh, cell, 1.0))) return std::nullopt;
  return cell;
}

}  // namespace contrejour::inline internal::adaptive
