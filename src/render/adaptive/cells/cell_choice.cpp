// Which cells a patch is drawn as: from the top down, each as large as its error allows.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/cells/cell_plane.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/frame_error.h"

namespace contrejour::adaptive {
namespace {

constexpr int kHalf = Mesh::kCells / 2;
constexpr int kDeepest = 7;          // quarterings of a patch
constexpr double kStraight = 0.05;   // of a cell's budget, below which straight sides do
// Half the cell, a fourth of the deviation of a curve from its chord: a sixteenth of the squared error.
constexpr double kGainOfHalving = 16.0;
constexpr double kPlane = 0.02;  // of a cell's budget, that a plane may leave of the irradiance of many
constexpr double kWorthPlane_px = 1000.0;  // fewer pixels: sides between cells are short
constexpr double kPlaneOff = 0.1;  // RMS, of its mean, however much the budget is

// Of a mesh, that holds the cell of size 1 there.
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

// Whether a line keeps the cell's crossings of the stop away from its rim: they may lie all around it, all outside.
bool CellPainter::misses_stop(const Mesh& mesh, const Cell& cell, int crossing) {
  const Mesh::Field& x = mesh.field(PatchLayout::kStop + 2 * crossing);
  const Mesh::Field& y = mesh.field(PatchLayout::kStop + 2 * crossing + 1);
  const Vec2 middle{x[cell.middle], y[cell.middle]};
  const double distance = length(middle);
  const auto beyond = [&](std::size_t v) { return dot(middle, Vec2{x[v], y[v]}) > distance; };
  return beyond(cell.middle) && std::all_of(cell.corner.begin(), cell.corner.end(), beyond) &&
         std::all_of(cell.side.begin(), cell.side.end(), beyond);
}

// Closed for certain only where one rim or one crossing of the iris blocks all of it. A screen cuts nothing: it is dark
// where its light ends.
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

// Whether a plane of some of a mesh's cells is worth its while and as good as each its own.
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

// Of all of it, or of those quarters that have one.
void CellPainter::find_planes(BoxMesh& of) const {
  const MeshSquare whole{0, 0, Mesh::kCells};
  LightSums light(of.mesh, quarter_square(0), blocking(of.mesh));
  for (std::size_t q = 1; q < 4; ++q) light.add({of.mesh, quarter_square(q), blocking(of.mesh)});
  const auto plane = light.plane(of.mesh, whole);
  if (plane && serves(*plane)) return of.plane.fill(of.keep(plane->shade));
  for (std::size_t q = 0; q < 4; ++q) of.plane[q] = of.keep(plane_for(of.mesh, quarter_square(q)));
}

// patch: what the mesh at that place is made of.
void CellPainter::choose(const Patch& patch, const MeshPlace& place, int depth, const Shade* plane) {
  BoxMesh& of = chosen_.add(place, plane);
  make_mesh(patch, iris_, of.mesh);
  const auto find_finer = [&](std::size_t q) {
    return depth < kDeepest && wants_finer_mesh(of, quarter_square(q), of.plane[q] != nullptr);
  };
  // Straight lines between four rays: a finer mesh of them shows nothing more.
  if (patch.nodes == 2) return choose(of, {0, 0, Mesh::kCells}, plane);
  std::array<bool, 4> finer{};
  for (std::size_t q = 0; q < 4; ++q) finer[q] = find_finer(q);
  // What so few nodes tell, nine vertices tell too.
  const bool whole = depth == 0 && patch.nodes <= 5 && std::ranges::none_of(finer, std::identity());
  if (!whole && plane == nullptr) {
    find_planes(of);
    for (std::size_t q = 0; q < 4; ++q)
      if (of.plane[q] != nullptr && finer[q]) finer[q] = find_finer(q);
  }
  const int first = patch.nodes <= 9 ? kHalf : kHalf / 2;  // 9 nodes: 3 x 3 vertices tell a quarter
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
    return std::isfinite(error) && error <= budget;  // an infinite budget allows no cell that must not be drawn
  };
  if (is_within(Sides::Straight, kStraight * cell_budget())) return choose_it(Sides::Straight);
  const Sides sides = is_dirty(of.mesh, cell) ? Sides::Straight : most_bent(state);
  if (is_within(sides, cell_budget())) return choose_it(sides);
  const Shade* const common = plane != nullptr ? plane : of.keep(plane_for(of.mesh, square));
  const int half = square.size / 2;
  for (int k = 0; k < 4; ++k) choose(of, {square.ix + (k % 2) * half, square.iy + (k / 2) * half, half}, common);
}

}  // namespace contrejour::adaptive
