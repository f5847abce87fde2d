// Which cells a patch is drawn as: from the top down, each as large as its error allows.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "render/adaptive/cell_painter.h"
#include "render/adaptive/cell_plane.h"
#include "render/adaptive/cell_shape.h"
#include "render/adaptive/frame_error.h"

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

CellPainter::Cell CellPainter::cell_at(const MeshSquare& square) {
  const auto [ix, iy, size] = square;
  Cell cell{.ix = ix, .iy = iy, .size = size};
  const int half = size / 2;
  cell.corner = {Mesh::at(ix, iy), Mesh::at(ix + size, iy), Mesh::at(ix + size, iy + size), Mesh::at(ix, iy + size)};
  cell.side = {Mesh::at(ix + half, iy), Mesh::at(ix + size, iy + half), Mesh::at(ix + half, iy + size),
               Mesh::at(ix, iy + half)};
  cell.middle = Mesh::at(ix + half, iy + half);
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

std::optional<std::pair<CellPainter::Cell, CellPainter::State>> CellPainter::seen_cell(const Mesh& mesh,
                                                                                       const std::array<bool, 4>& finer,
                                                                                       const MeshSquare& square) const {
  const auto [ix, iy, size] = square;
  Cell cell = cell_at(square);
  const auto same_mesh = [&](int x, int y) {
    const auto inside = [](int v) { return v >= 0 && v < Mesh::kCells; };
    return inside(x) && inside(y) && !finer[quarter_at(x, y)];
  };
  cell.shared = {same_mesh(ix, iy - 1), same_mesh(ix + size, iy), same_mesh(ix, iy + size), same_mesh(ix - 1, iy)};
  const State state = state_of(mesh, cell);
  if (state == State::Closed || off_frame(mesh, cell)) return std::nullopt;
  cell.screen = view_of_screen(mesh, cell);
  if (cell.screen.part == ScreenPart::Dark || (screen_ && is_dim(mesh, cell, 1.0))) return std::nullopt;
  return std::pair(cell, state);
}

bool CellPainter::wants_finer_mesh(const Mesh& mesh, const MeshSquare& square, bool on_plane) const {
  for (int y = square.iy; y < square.iy + square.size; y += 2) {
    for (int x = square.ix; x < square.ix + square.size; x += 2) {
      const auto seen = seen_cell(mesh, {}, {x, y, 2});
      if (!seen) continue;
      const auto& [cell, state] = *seen;
      CellMeasure of = measure(mesh, cell, state, on_plane);
      if (squared_error(mesh, cell, of, state, most_bent(state)) > kGainOfHalving * cell_budget()) return true;
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
void CellPainter::find_planes(const Mesh& mesh, ChosenCells& chosen) const {
  const MeshSquare whole{0, 0, Mesh::kCells};
  LightSums light(mesh, quarter_square(0), blocking(mesh));
  for (std::size_t q = 1; q < 4; ++q) light.add({mesh, quarter_square(q), blocking(mesh)});
  const auto plane = light.plane(mesh, whole);
  if (plane && serves(*plane)) return chosen.plane.fill(chosen.keep(plane->shade));
  for (std::size_t q = 0; q < 4; ++q) chosen.plane[q] = chosen.keep(plane_for(mesh, quarter_square(q)));
}

void CellPainter::paint(const Patch& patch, int depth, const Shade* plane) {
  const auto at = static_cast<std::size_t>(depth);
  while (meshes_.size() <= at) meshes_.emplace_back();
  Mesh& mesh = meshes_[at].first;
  ChosenCells& chosen = meshes_[at].second;
  make_mesh(patch, iris_, mesh);
  chosen.start_with(plane);
  const auto find_finer = [&](std::size_t q) {
    return depth < kDeepest && wants_finer_mesh(mesh, quarter_square(q), chosen.plane[q] != nullptr);
  };
  for (std::size_t q = 0; q < 4; ++q) chosen.finer[q] = find_finer(q);
  // What so few nodes tell, nine vertices tell too.
  const bool whole = depth == 0 && patch.nodes <= 5 && std::ranges::none_of(chosen.finer, std::identity());
  if (whole) {
    choose(mesh, {0, 0, Mesh::kCells}, plane, chosen);
  } else if (plane == nullptr) {
    find_planes(mesh, chosen);
    for (std::size_t q = 0; q < 4; ++q)
      if (chosen.plane[q] != nullptr && chosen.finer[q]) chosen.finer[q] = find_finer(q);
  }
  const int first = patch.nodes <= 9 ? kHalf : kHalf / 2;  // 9 nodes: 3 x 3 vertices tell a quarter
  for (int y = 0; y < Mesh::kCells; y += first) {
    for (int x = 0; x < Mesh::kCells; x += first) {
      const std::size_t q = quarter_at(x, y);
      if (!whole && !chosen.finer[q]) choose(mesh, {x, y, first}, chosen.plane[q], chosen);
    }
  }
  for (const ChosenCell& cell : chosen.cells) draw(mesh, cell, chosen.corners);
  for (std::size_t q = 0; q < 4; ++q)
    if (chosen.finer[q])
      paint(quarter(patch, static_cast<int>(q % 2), static_cast<int>(q / 2)), depth + 1, chosen.plane[q]);
}

void CellPainter::ChosenCells::add(const ChosenCell& chosen) {
  cells.push_back(chosen);
  for (const std::size_t vertex : chosen.cell.corner) corners.set(vertex);
  for (const std::size_t vertex : chosen.cell.side)
    if (chosen.sides == Sides::Bent) corners.set(vertex);
}

void CellPainter::ChosenCells::start_with(const Shade* given) {
  finer.fill(false);
  plane.fill(given);
  planes.clear();
  cells.clear();
  corners.reset();
}

const Shade* CellPainter::ChosenCells::keep(const std::optional<Shade>& some) {
  return some ? &planes.emplace_front(*some) : nullptr;
}

void CellPainter::choose(const Mesh& mesh, const MeshSquare& square, const Shade* plane, ChosenCells& chosen) {
  const auto seen = seen_cell(mesh, chosen.finer, square);
  if (!seen) return;
  const auto& [cell, state] = *seen;
  const auto choose_it = [&](Sides sides) {
    cells_ += 1.0;
    chosen.add({cell, state, sides, plane});
  };
  if (square.size == 1) return choose_it(Sides::Straight);
  CellMeasure of = measure(mesh, cell, state, plane != nullptr);
  if (squared_error(mesh, cell, of, state, Sides::Straight) <= kStraight * cell_budget())
    return choose_it(Sides::Straight);
  const Sides sides = is_dirty(mesh, cell) ? Sides::Straight : most_bent(state);
  if (squared_error(mesh, cell, of, state, sides) <= cell_budget()) return choose_it(sides);
  const Shade* const common = plane != nullptr ? plane : chosen.keep(plane_for(mesh, square));
  const int half = square.size / 2;
  for (int k = 0; k < 4; ++k)
    choose(mesh, {square.ix + (k % 2) * half, square.iy + (k / 2) * half, half}, common, chosen);
}

}  // namespace contrejour::adaptive
