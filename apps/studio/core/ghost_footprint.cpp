// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_footprint.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

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

struct Landing {
  bool is_ray = false;  // it reaches the sensor, if nothing blocks it
  Vec2 sensor_mm;
  double blocked = 1;  // <= 0: it gets through
  [[nodiscard]] bool is_lit() const { return is_ray && blocked <= 0; }
};
using Landings = std::vector<Landing>;

const Landing& at(const Landings& landings, int column, int row) {
  return landings[static_cast<std::size_t>(row * kSide + column)];
}

Landings land(const OpticalPath& path, const LensState& lens, const LightSource& source, double z_mm,
              const Window& window) {
  Landings landings;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const Vec2 place = window.at(column, row);
      const Vec3 point{place.x, place.y, z_mm};
      const TracedRay ray = trace(path, {point, source.direction_at(point)});
      const bool is_ray = ray.status == RayStatus::Ok;
      landings.push_back({is_ray, ray.sensor_mm, is_ray ? blocked_by(ray, path, lens.iris) : 1.0});
    }
  return landings;
}

// About the rays that get through, a cell wider.
std::optional<Window> lit_part(const Landings& landings, const Window& window) {
  int left = kSide, right = -1, top = kSide, bottom = -1;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      if (!at(landings, column, row).is_lit()) continue;
      left = std::min(left, column);
      right = std::max(right, column);
      top = std::min(top, row);
      bottom = std::max(bottom, row);
    }
  if (right < 0) return std::nullopt;
  return Window{window.at(std::max(0, left - 1), std::max(0, top - 1)),
                window.at(std::min(kSide - 1, right + 1), std::min(kSide - 1, bottom + 1))};
}

// The lit part of a cell: its lit corners, and the points between a lit and a blocked one where the border is.
void add_cell(const std::array<const Landing*, 4>& corners, const Frame& frame, GhostFootprint& footprint) {
  std::vector<Vec2> polygon, crossings;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Landing &here = *corners[k], &next = *corners[(k + 1) % corners.size()];
    if (here.is_lit()) polygon.push_back(frame.pixel_from_sensor(here.sensor_mm));
    if (here.is_lit() == next.is_lit()) continue;
    const double part = here.blocked / (here.blocked - next.blocked);
    const Vec2 crossing = frame.pixel_from_sensor(here.sensor_mm + (next.sensor_mm - here.sensor_mm) * part);
    polygon.push_back(crossing);
    crossings.push_back(crossing);
  }
  if (polygon.size() >= 3) footprint.cells_px.push_back(std::move(polygon));
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
    footprint.border_px.push_back({crossings[k], crossings[k + 1]});
}

// By the crossings of a ray to the right, so that folded cells count, too.
bool is_inside(const std::vector<Vec2>& cell, Vec2 p) {
  bool inside = false;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const Vec2 a = cell[k], b = cell[(k + 1) % cell.size()];
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
    for (int column = 0; column + 1 < kSide; ++column) {
      const std::array<const Landing*, 4> corners = {&at(landings, column, row), &at(landings, column + 1, row),
                                                     &at(landings, column + 1, row + 1),
                                                     &at(landings, column, row + 1)};
      if (std::ranges::all_of(corners, [](const Landing* corner) { return corner->is_ray; }))
        add_cell(corners, frame, footprint);
    }
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
