// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/cell_emitter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/adaptive/budget/arc_step.h"
#include "render/adaptive/budget/pattern_budget.h"
#include "render/adaptive/budget/plane_errors.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/stop_crossings.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kMinThickness = 0.05;  // minimum thickness of cells in stop maps, over their length, or maps of small
                                        // cells would be constant

// A cell's corners, and the middles of its sides if they are curved.
struct CellShape {
  std::array<CellCorner, 8> corners;
  std::size_t count = 0;

  CellShape(const Mesh& mesh, const Cell& cell, Sides sides) {
    constexpr std::array<Vec2, 4> kCorner{Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};
    constexpr std::array<Vec2, 4> kSide{Vec2{0.5, 0}, Vec2{1, 0.5}, Vec2{0.5, 1}, Vec2{0, 0.5}};
    for (std::size_t k = 0; k < 4; ++k) {
      corners[count++] = CellCorner::at_vertex(mesh, cell.corner[k], kCorner[k]);
      if (sides == Sides::Curved) corners[count++] = CellCorner::at_vertex(mesh, cell.side[k], kSide[k]);
    }
  }
  [[nodiscard]] std::span<const CellCorner> all() const { return {corners.data(), count}; }
};

// The two triangles of a cell that is not drawn whole, as vertices, and as corners.
using Triangle = std::array<std::size_t, 3>;
std::array<Triangle, 2> triangles_of(const Cell& cell) {
  return {Triangle{cell.corner[0], cell.corner[1], cell.corner[2]},
          Triangle{cell.corner[0], cell.corner[2], cell.corner[3]}};
}
std::array<CellCorner, 3> corners_of(const Mesh& mesh, const Triangle& t) {
  return {CellCorner::at_vertex(mesh, t[0], {0, 0}), CellCorner::at_vertex(mesh, t[1], {1, 0}),
          CellCorner::at_vertex(mesh, t[2], {1, 1})};
}

bool is_convex(const Mesh& mesh, const Cell& cell, double signed_px) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = mesh.position(cell.corner[k]);
    const Vec2 b = mesh.position(cell.corner[(k + 1) % 4]), c = mesh.position(cell.corner[(k + 2) % 4]);
    if (!(cross(b - a, c - a) * signed_px > 0.0 && mesh.area[cell.corner[k]] * signed_px > 0.0)) return false;
  }
  return true;
}

}  // namespace

void CellEmitter::emit(const BoxMesh& of, const ChosenCell& chosen) {
  const Cell& cell = chosen.cell;
  const Mesh& mesh = of.mesh;
  cells_.outline(of, cell, all_corners_);
  const auto [area, centroid] = area_of(all_corners_.size(), [&](std::size_t k) { return all_corners_[k].position; });
  const auto at = [&](std::size_t k) { return mesh.position(cell.corner[k]); };
  const DrawnShape shape{area, centroid, at(2) - at(0), at(3) - at(1)};
  const double longest = shape.longest_px();
  const bool varied = cell.pattern.part == PatternRegion::Varying;
  const bool by_parts = varied && sees_by_parts(band_, mesh, cell, longest);
  std::optional<Flux> mean;
  if (varied && (by_parts || is_dim(band_, mesh, cell, kMeanBelow))) {
    const std::size_t across = by_parts ? parts_across(band_, mesh, cell, longest) : CellParts::kMinAcross;
    const CellParts parts = parts_of(band_, mesh, cell, across);
    if (by_parts && cell.state == CellState::Open && !is_dirty(band_, mesh, cell) &&
        parts.are_nonuniform(ignored_difference(band_, brightest(mesh, cell))))
      return emit_parts(mesh, cell, parts);
    mean = parts.mean();
  }
  if (!is_convex(mesh, cell, area)) return emit_folded(mesh, cell, mean);

  CellLight light = light_of(mesh, cell, shape);
  if (chosen.plane != nullptr) light.irradiance = *chosen.plane;
  if (mean) light.dim(*mean);
  if (!varied || mean) return emit_convex(mesh, chosen, light, nullptr);
  const StopMap map = stop_map(band_, mesh, cell, std::min(kMinThickness_px, kMinThickness * longest));
  emit_convex(mesh, chosen, light, &map);
}

// map: null where no stop pattern varies over the cell.
void CellEmitter::emit_convex(const Mesh& mesh, const ChosenCell& chosen, const CellLight& light, const StopMap* map) {
  const Cell& cell = chosen.cell;
  if (is_dirty(band_, mesh, cell)) return emit_dirty(mesh, cell, light, map);
  const CellShape shape(mesh, cell, chosen.sides);
  emit_outline(mesh, cell.state, light, {shape.all(), all_corners_}, {map, nullptr, cell.pattern.max_transmittance});
}

// Emits each part as a polygon of its own, with its part of the cell's flux.
void CellEmitter::emit_parts(const Mesh& mesh, const Cell& cell, const CellParts& parts) {
  std::array<Vec2, 4> corner;
  for (std::size_t k = 0; k < 4; ++k) corner[k] = mesh.position(cell.corner[k]) + mesh.origin_px;
  const Flux flux = flux_of(mesh, cell);
  for (std::size_t k = 0; k < parts.count(); ++k) {
    CellLight light{.flux = flux};
    for (std::size_t c = 0; c < 3; ++c) light.flux[c] *= parts.values[k][c];
    if (light.flux == Flux{}) continue;
    std::array<Corner, 4> part;
    for (std::size_t j = 0; j < 4; ++j) {
      part[j].uv = parts.corner(k, j);
      part[j].position = CellParts::between(corner, part[j].uv);
    }
    const Vec2 middle = (part[0].position + part[2].position) * 0.5;
    light.irradiance.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
    polygons_.emit(part, light, {});
  }
}

// Emits a folded cell as two triangles, each with its own flux at constant irradiance. mean: of the stop pattern, if it
// is not looked up.
void CellEmitter::emit_folded(const Mesh& mesh, const Cell& cell, const std::optional<Flux>& mean) {
  for (const Triangle& t : triangles_of(cell)) {
    const std::array<CellCorner, 3> corners = corners_of(mesh, t);
    CellLight light = light_of(mesh, cell, t);
    if (mean) light.dim(*mean);
    const bool looks_up = cell.pattern.part == PatternRegion::Varying && !mean;
    const auto map = looks_up ? std::optional(stop_map(band_, mesh, t)) : std::nullopt;
    const auto dirt = is_dirty(band_, mesh, cell) ? std::optional(dirt_triangle(band_, mesh, t)) : std::nullopt;
    emit_outline(mesh, cell.state, light, {corners, corners},
                 {map ? &*map : nullptr, dirt ? &*dirt : nullptr, cell.pattern.max_transmittance});
  }
}

// Emits a cell whose light passes dirt as two triangles, over which points in the dirt's plane are linear.
void CellEmitter::emit_dirty(const Mesh& mesh, const Cell& cell, const CellLight& light, const StopMap* map) {
  CellLight half = light;
  half.triangle = true;
  for (double& flux : half.flux) flux *= 0.5;
  for (const Triangle& t : triangles_of(cell)) {
    const std::array<CellCorner, 3> corners = corners_of(mesh, t);
    const DirtTriangle dirt = dirt_triangle(band_, mesh, t);
    emit_outline(mesh, cell.state, half, {corners, corners}, {map, &dirt});
  }
}

void CellEmitter::emit_outline(const Mesh& mesh, CellState state, const CellLight& light, const CellOutline& outline,
                               const Occluders& occluders) {
  if (clipper_.by_picture(state)) {
    clipper_.for_each_open_part(mesh, outline, [&](std::span<const Corner> part, double open) {
      CellLight dimmed = light;
      dimmed.dim({open, open, open});
      polygons_.emit(part, dimmed, occluders);
    });
    return;
  }
  const double step_rad =
      clipper_.by_arcs(state) ? arc_step(band_, mesh, outline.shape, light.irradiance, budget_.of_next_cell()) : 0.0;
  polygons_.emit(clipper_.open_part(mesh, state, outline, step_rad), light, occluders);
}

}  // namespace contrejour::inline internal::adaptive
