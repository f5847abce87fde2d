// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/choose/cell_chooser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "render/adaptive/budget/cell_choice.h"
#include "render/adaptive/budget/cell_error.h"
#include "render/adaptive/cells/dirt_crossings.h"
#include "render/adaptive/choose/common_plane.h"
#include "render/adaptive/choose/visible_cell.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr int kHalf = Mesh::kCells / 2;

// The quarter of a mesh that contains the cell of size 1 at x, y.
std::size_t quarter_at(int x, int y) { return static_cast<std::size_t>(2 * (y / kHalf) + x / kHalf); }

}  // namespace

bool CellChooser::wants_finer_mesh(const BoxMesh& in, const MeshSquare& square, bool uses_common_plane) const {
  const double cell_budget = budget_.of_next_cell();
  for (int y = square.iy; y < square.iy + square.size; y += 2) {
    for (int x = square.ix; x < square.ix + square.size; x += 2) {
      const auto cell = visible_cell(band_, in, {x, y, 2});
      if (!cell) continue;
      CellError error(band_, in.mesh, *cell, uses_common_plane);
      if (error.squared(finest_sides(cell->state, band_.iris), cell_budget) > kGainOfHalving * cell_budget) return true;
    }
  }
  return false;
}

// patch: the polynomials that the mesh at `position` is evaluated from.
void CellChooser::choose(const Patch& patch, const MeshPosition& position, int depth, const LinearIrradiance* plane) {
  BoxMesh& of = cells_.add(position, plane);
  make_mesh(patch, band_.iris, of.mesh);
  const auto find_finer = [&](std::size_t q) {
    return depth < kMaxMeshDepth && wants_finer_mesh(of, quarter_square(q), of.plane[q] != nullptr);
  };
  // The patch is bilinear between four rays, so that a finer mesh of it would show nothing more.
  if (patch.nodes == 2) return choose(of, {0, 0, Mesh::kCells}, plane);
  std::array<bool, 4> finer{};
  for (std::size_t q = 0; q < 4; ++q) finer[q] = find_finer(q);
  // Polynomials through no more than 5 x 5 nodes are known well enough from nine vertices.
  const bool whole = depth == 0 && patch.nodes <= 5 && std::ranges::none_of(finer, std::identity());
  if (!whole && plane == nullptr) {
    find_planes(band_, of, budget_.of_next_cell());
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
      choose(quarter(patch, static_cast<int>(q % 2), static_cast<int>(q / 2)), position.quarter(q), depth + 1,
             of.plane[q]);
}

void CellChooser::choose(BoxMesh& of, const MeshSquare& square, const LinearIrradiance* plane) {
  const auto cell = visible_cell(band_, of, square);
  if (!cell) return;
  const auto choose_it = [&](Sides sides) {
    budget_.add_cell();
    of.add({*cell, sides, plane});
  };
  if (square.size == 1) return choose_it(Sides::Straight);
  const double cell_budget = budget_.of_next_cell();
  CellError error(band_, of.mesh, *cell, plane != nullptr);
  const auto is_within = [&](Sides sides, double budget) {
    const double squared = error.squared(sides, cell_budget);
    return std::isfinite(squared) && squared <= budget;  // an infinite budget allows no infinite error
  };
  if (is_within(Sides::Straight, kStraight * cell_budget)) return choose_it(Sides::Straight);
  const Sides sides = is_dirty(band_, of.mesh, *cell) ? Sides::Straight : finest_sides(cell->state, band_.iris);
  if (is_within(sides, cell_budget)) return choose_it(sides);
  const LinearIrradiance* const common =
      plane != nullptr ? plane : of.keep(plane_for(band_, of.mesh, square, cell_budget));
  const int half = square.size / 2;
  for (int k = 0; k < 4; ++k) choose(of, {square.ix + (k % 2) * half, square.iy + (k / 2) * half, half}, common);
}

}  // namespace contrejour::inline internal::adaptive
