// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_footprint.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contrejour/expert/trace.h"

namespace contrejour::studio {
namespace {

constexpr int kSide = 17;  // rays along each side of a grid

struct Window {
  Vec2 min, max;
  [[nodiscard]] Vec2 at(int column, int row) const {
    const double u = static_cast<double>(column) / (kSide - 1), v = static_cast<double>(row) / (kSide - 1);
    return {min.x + (max.x - min.x) * u, min.y + (max.y - min.y) * v};
  }
};

// Where the rays of a grid land; none where a ray does not get through.
using Landings = std::vector<std::optional<Vec2>>;

std::size_t index_of(int column, int row) { return static_cast<std::size_t>(row * kSide + column); }

Landings land(const OpticalPath& path, const LensState& lens, const LightSource& source, double z_mm,
              const Window& window) {
  Landings landings(static_cast<std::size_t>(kSide) * kSide);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const Vec2 at = window.at(column, row);
      const Vec3 point{at.x, at.y, z_mm};
      const TracedRay ray = trace(path, {point, source.direction_at(point)});
      if (ray.status == RayStatus::Ok && blocked_by(ray, path, lens.iris) <= 0)
        landings[index_of(column, row)] = ray.sensor_mm;
    }
  return landings;
}

// About the rays that get through, a cell wider.
std::optional<Window> lit_part(const Landings& landings, const Window& window) {
  int left = kSide, right = -1, top = kSide, bottom = -1;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      if (!landings[index_of(column, row)]) continue;
      left = std::min(left, column);
      right = std::max(right, column);
      top = std::min(top, row);
      bottom = std::max(bottom, row);
    }
  if (right < 0) return std::nullopt;
  return Window{window.at(std::max(0, left - 1), std::max(0, top - 1)),
                window.at(std::min(kSide - 1, right + 1), std::min(kSide - 1, bottom + 1))};
}

bool is_lit(const Landings& landings, int column, int row) {
  if (column < 0 || row < 0 || column + 1 >= kSide || row + 1 >= kSide) return false;
  return landings[index_of(column, row)] && landings[index_of(column + 1, row)] &&
         landings[index_of(column, row + 1)] && landings[index_of(column + 1, row + 1)];
}

void add_cell(const Landings& landings, int column, int row, const Frame& frame, GhostFootprint& footprint) {
  const auto corner = [&](int dx, int dy) {
    return frame.pixel_from_sensor(*landings[index_of(column + dx, row + dy)]);
  };
  const std::array<Vec2, 4> cell = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  footprint.cells_px.push_back(cell);
  static constexpr std::array<std::array<int, 2>, 4> kNeighbours = {{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  for (std::size_t k = 0; k < 4; ++k)
    if (!is_lit(landings, column + kNeighbours[k][0], row + kNeighbours[k][1]))
      footprint.border_px.push_back({cell[k], cell[(k + 1) % 4]});
}

// By the crossings of a ray to the right, so that folded cells count, too.
bool is_inside(const std::array<Vec2, 4>& cell, Vec2 p) {
  bool inside = false;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = cell[k], b = cell[(k + 1) % 4];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

double distance_to_side(const std::array<Vec2, 2>& side, Vec2 p) {
  const Vec2 along = side[1] - side[0], from = p - side[0];
  const double part = std::clamp(dot(from, along) / std::fmax(dot(along, along), 1e-12), 0.0, 1.0);
  const Vec2 away = from - along * part;
  return std::hypot(away.x, away.y);
}

}  // namespace

bool GhostFootprint::contains(Vec2 p, double reach_px) const {
  return std::ranges::any_of(cells_px, [&](const auto& cell) { return is_inside(cell, p); }) ||
         std::ranges::any_of(border_px, [&](const auto& side) { return distance_to_side(side, p) <= reach_px; });
}

GhostFootprint footprint_of(const LensState& lens, const Ghost& ghost, const Light& light, const Frame& frame) {
  GhostFootprint footprint{ghost, {}, {}};
  const OpticalPath path = ghost_path(lens, ghost, lens.design_wavelength_nm);
  const LightSource source = light.source();
  const EntranceWindow entrance = entrance_window(lens, source);
  const Window whole{entrance.min_mm, entrance.max_mm};
  const auto lit = lit_part(land(path, lens, source, entrance.z_mm, whole), whole);
  if (!lit) return footprint;
  const Landings landings = land(path, lens, source, entrance.z_mm, *lit);
  for (int row = 0; row + 1 < kSide; ++row)
    for (int column = 0; column + 1 < kSide; ++column)
      if (is_lit(landings, column, row)) add_cell(landings, column, row, frame, footprint);
  return footprint;
}

std::vector<GhostFootprint> footprints_of(const LensState& lens, const std::vector<GhostFigures>& figures,
                                          const Light& light, const Frame& frame, const Context& context) {
  std::vector<GhostFootprint> footprints;
  for (std::size_t k = 0; k < std::min(kMostFootprints, figures.size()) && !context.cancelled(); ++k)
    footprints.push_back(footprint_of(lens, figures[k].ghost, light, frame));
  return footprints;
}

}  // namespace contrejour::studio
