// SPDX-License-Identifier: Apache-2.0
// Chooses the cells that a patch is drawn as: from the top down, each as large as its allowed error permits.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/cells/cell_plane.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/frame_error.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr int kHalf = Mesh::kCells / 2;
constexpr int kDeepest = 7;          // the most times that a patch may be quartered
constexpr double kStraight = 0.05;   // fraction of a cell's budget below which straight sides are good enough
// Halving a cell reduces the deviation of a curve from its chord to a fourth, and the squared error to a sixteenth.
constexpr double kGainOfHalving = 16.0;
constexpr double kPlane = 0.02;  // fraction of a cell's budget that one plane for many cells may leave
constexpr double kWorthPlane_px = 1000.0;  // minimum area of a plane: smaller ones save few sides between cells
constexpr double kPlaneOff = 0.1;  // largest RMS residual of a common plane over its mean, whatever the budget

// The quarter of a mesh that contains the cell of size 1 at x, y.
std::size_t quarter_at(int x, int y) { return static_cast<std::size_t>(2 * (y / kHalf) + x / kHalf); }
MeshSquare quarter_square(std::size_t q) {
  return {kHalf * static_cast<int>(q % 2), kHalf * static_cast<int>(q / 2), kHalf};
}

}  // namespace

Cell CellPainter::cell_at(const BoxMesh& of, const MeshSquare& square) {
  const auto [ix, iy, size] = square;
  Cell cell{.ix = ix, .iy = iy, .size = size};
  const int half = size / 2;
  cell.corner = {Mesh::at(ix, iy), Mesh::at(ix + size, iy), Mesh::at(ix + size, iy + size), Mesh::at(ix, iy + size)};
  cell.side = {Mesh::at(ix + half, iy), Mesh::at(ix + size, iy + half), Mesh::at(ix + half, iy + size),
               Mesh::at(ix, iy + half)};
  cell.middle = Mesh::at(ix + half, iy + half);
  const MeshPlace& at = of.place;
  const int x = at.x + ix * at.step, y = at.y + iy * at.step, length = size * at.step;
  cell.shared = {y > 0, x + length < MeshPlace::kWhole, y + length < MeshPlace::kWhole, x > 0};
  return cell;
}

// Whether a straight line separates all of the cell's crossings of the stop from its rim. Crossings that are all
// outside the stop may still surround it.
bool CellPainter::misses_stop(const Mesh& mesh, const Cell& cell, int crossing) {
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
CellPainter::State CellPainter::state_of(const Mesh& mesh, const Cell& cell) const {
  std::uint32_t any = 0;
  std::uint32_t all = ~0U;
  for (int y = cell.iy; y <= cell.iy + cell.size; ++y) {
    for (int x = cell.ix; x <= cell.ix + cell.size; ++x) {
      any |= mesh.outside[Mesh::at(x, y)];
      all &= mesh.outside[Mesh::at(x, y)];
    }
  }
  all &= ~Mesh::kNearObscuration;
  if ((screen_ ? any >> mesh.layout.crossings : any) == 0) return State::Open;
  if (all >> mesh.layout.crossings != 0) return State::Closed;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    if ((all >> c & 1U) != 0 && misses_stop(mesh, cell, c)) return State::Closed;
  }
  return State::Cut;
}

bool CellPainter::off_frame(const Mesh& mesh, const Cell& cell) const {
  Bounds b;
  for (const std::size_t v : cell.corner) b.add(mesh.position(v));
  for (const std::size_t v : cell.side) b.add(mesh.position(v));
  const Vec2 low = b.low + mesh.origin_px;
  const Vec2 high = b.high + mesh.origin_px;
  return !(high.x > 0.0 && high.y > 0.0 && low.x < width_ && low.y < height_);
}

std::optional<std::pair<Cell, CellState>> CellPainter::seen_cell(const BoxMesh& of, const MeshSquare& square) const {
  const Mesh& mesh = of.mesh;
  Cell cell = cell_at(of, square);
  const State state = state_of(mesh, cell);
  if (state == State::Closed || off_frame(mesh, cell)) return std::nullopt;
  cell.screen = view_of_screen(mesh, cell);
  if (cell.screen.part == ScreenPart::Dark || (screen_ && is_dim(mesh, cell, 1.0))) return std::nullopt;
  return std::pair(cell, state);
}

bool CellPainter::wants_finer_mesh(const BoxMesh& in, const MeshSquare& square, bool on_plane) const {
  for (int y = square.iy; y < square.iy + square.size; y += 2) {
    for (int x = square.ix; x < square.ix + square.size; x += 2) {
      const auto seen = seen_cell(in, {x, y, 2});
      if (!seen) continue;
      const auto& [cell, state] = *seen;
      CellMeasure of = measure(in.mesh, cell, state, on_plane);
      if (squared_error(in.mesh, cell, of, state, most_bent(state)) > kGainOfHalving * cell_budget()) return true;
    }
  }
  return false;
}

// Whether one plane for several cells of a mesh saves enough work and is as good as a plane for each cell.
bool CellPainter::serves(const IrradiancePlane& plane) const {
  if (plane.area_px < kWorthPlane_px) return false;
  const double seen = seen_share(plane.mean, peak_);
  const double off_plane = plane.squared_error / plane.area_px;
  return plane.squared_error * seen * seen <= kPlane * cell_budget() &&
         off_plane <= kPlaneOff * kPlaneOff * plane.mean * plane.mean &&
         !shows_facets(plane.area_px, plane.mean, off_plane);
}

std::optional<Shade> CellPainter::plane_for(const Mesh& mesh, const MeshSquare& square) const {
  const std::size_t middle = Mesh::at(square.ix + square.size / 2, square.iy + square.size / 2);
  if (std::abs(mesh.area[middle]) * square.size * square.size < kWorthPlane_px) return std::nullopt;
  const auto plane = LightSums(mesh, square, blocking(mesh)).plane(mesh, square);
  return plane && serves(*plane) ? std::optional(plane->shade) : std::nullopt;
}

// Finds one plane for the whole mesh, or else one for each quarter that a plane represents well enough.
void CellPainter::find_planes(BoxMesh& of) const {
  const MeshSquare whole{0, 0, Mesh::kCells};
  LightSums light(of.mesh, quarter_square(0), blocking(of.mesh));
  for (std::size_t q = 1; q < 4; ++q) light.add({of.mesh, quarter_square(q), blocking(of.mesh)});
  const auto plane = light.plane(of.mesh, whole);
  if (plane && serves(*plane)) return of.plane.fill(of.keep(plane->shade));
  for (std::size_t q = 0; q < 4; ++q) of.plane[q] = of.keep(plane_for(of.mesh, quarter_square(q)));
}

// patch: the polynomials that the mesh at `place` is evaluated from.
void CellPainter::choose(const Patch& patch, const MeshPlace& place, int depth, const Shade* plane) {
  BoxMesh& of = chosen_.add(place, plane);
  make_mesh(patch, iris_, of.mesh);
  const auto find_finer = [&](std::size_t q) {
    return depth < kDeepest && wants_finer_mesh(of, quarter_square(q), of.plane[q] != nullptr);
  };
  // The patch is bilinear between four rays, so that a finer mesh of it would show nothing more.
  if (patch.nodes == 2) return choose(of, {0, 0, Mesh::kCells}, plane);
  std::array<bool, 4> finer{};
  for (std::size_t q = 0; q < 4; ++q) finer[q] = find_finer(q);
  // Polynomials through no more than 5 x 5 nodes are known well enough from nine vertices.
  const bool whole = depth == 0 && patch.nodes <= 5 && std::ranges::none_of(finer, std::identity());
  if (!whole && plane == nullptr) {
    find_planes(of);
    for (std::size_t q = 0; q < 4; ++q)
      if (of.plane[q] != nullptr && finer[q]) finer[q] = find_finer(q);
  }
  const int first = patch.nodes <= 9 ? kHalf : kHalf / 2;  // 3 x 3 vertices a quarter are enough for 9 x 9 nodes
  if (whole) choose(of, {0, 0, Mesh::kCells}, plane);
  for (int y = 0; y < Mesh::kCells && !whole; y += first) {
    for (int x = 0; x < Mesh::kCells; x += first) {
      const std::size_t q = quarter_at(x, y);
      if (!finer[q]) choose(of, {x, y, first}, of.plane[q]);
    }
  }
  for (std::size_t q = 0; q < 4; ++q)
    if (finer[q])
      choose(quarter(patch, static_cast<int>(q % 2), static_cast<int>(q / 2)), place.quarter(q), depth + 1,
             of.plane[q]);
}

void CellPainter::choose(BoxMesh& of, const MeshSquare& square, const Shade* plane) {
  const auto seen = seen_cell(of, square);
  if (!seen) return;
  const auto& [cell, state] = *seen;
  const auto choose_it = [&](Sides sides) {
    cells_ += 1.0;
    of.add({cell, state, sides, plane});
  };
  if (square.size == 1) return choose_it(Sides::Straight);
  CellMeasure measured = measure(of.mesh, cell, state, plane != nullptr);
  const auto is_within = [&](Sides sides, double budget) {
    const double error = squared_error(of.mesh, cell, measured, state, sides);
    return std::isfinite(error) && error <= budget;  // an infinite budget allows no infinite error
  };
  if (is_within(Sides::Straight, kStraight * cell_budget())) return choose_it(Sides::Straight);
  const Sides sides = is_dirty(of.mesh, cell) ? Sides::Straight : most_bent(state);
  if (is_within(sides, cell_budget())) return choose_it(sides);
  const Shade* const common = plane != nullptr ? plane : of.keep(plane_for(of.mesh, square));
  const int half = square.size / 2;
  for (int k = 0; k < 4; ++k) choose(of, {square.ix + (k % 2) * half, square.iy + (k / 2) * half, half}, common);
}

}  // namespace contrejour::inline internal::adaptive
