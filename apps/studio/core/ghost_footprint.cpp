// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
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
  double transmission = 0;
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
      landings.push_back(
          {is_ray, ray.sensor_mm, is_ray ? blocked_by(ray, path, lens.iris) : 1.0, is_ray ? ray.transmission : 0.0});
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

double area_of(const std::vector<Vec2>& polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * std::fabs(twice);
}

Vec2 middle_of(const std::vector<Vec2>& polygon) {
  Vec2 sum{};
  for (const Vec2 p : polygon) sum = sum + p;
  return sum * (1.0 / static_cast<double>(polygon.size()));
}

// The lit part of a cell: its lit corners, and the points between a lit and a blocked one where the border is. The
// cell's light is its area in the pupil, in cells, times its transmittance, until all are known.
void add_cell(const std::array<const Landing*, 4>& corners, const Frame& frame, GhostFootprint& footprint) {
  constexpr std::array<Vec2, 4> kPupilCorners = {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};
  std::vector<Vec2> polygon, in_pupil, crossings;
  double transmission = 0, lit = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t after = (k + 1) % corners.size();
    const Landing &here = *corners[k], &next = *corners[after];
    if (here.is_lit()) {
      polygon.push_back(frame.pixel_from_sensor(here.sensor_mm));
      in_pupil.push_back(kPupilCorners[k]);
      transmission += here.transmission;
      ++lit;
    }
    if (here.is_lit() == next.is_lit()) continue;
    const double part = here.blocked / (here.blocked - next.blocked);
    const Vec2 crossing = frame.pixel_from_sensor(here.sensor_mm + (next.sensor_mm - here.sensor_mm) * part);
    polygon.push_back(crossing);
    in_pupil.push_back(kPupilCorners[k] + (kPupilCorners[after] - kPupilCorners[k]) * part);
    crossings.push_back(crossing);
  }
  if (polygon.size() >= 3) {
    footprint.cells_px.push_back(std::move(polygon));
    footprint.cell_light.push_back(area_of(in_pupil) * transmission / lit);
  }
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

// Cells smaller than the disc, as where light is focused, count by their middle.
double GhostFootprint::irradiance_at(Vec2 p, double radius_px) const {
  const double disc_px2 = std::numbers::pi * radius_px * radius_px;
  double sum = 0;
  for (std::size_t k = 0; k < cells_px.size(); ++k) {
    const double area = area_of(cells_px[k]);
    const Vec2 away = middle_of(cells_px[k]) - p;
    const bool is_here = area < disc_px2 ? std::hypot(away.x, away.y) <= radius_px : is_inside(cells_px[k], p);
    if (is_here) sum += cell_light[k] / std::fmax(area, disc_px2);
  }
  return sum;
}

GhostFootprint footprint_of(const LensState& lens, const Ghost& ghost, const Light& light, const Frame& frame) {
  GhostFootprint footprint{ghost, {}, {}, {}};
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
  double all = 0;
  for (const double light_of_cell : footprint.cell_light) all += light_of_cell;
  for (double& light_of_cell : footprint.cell_light) light_of_cell = all > 0 ? light_of_cell / all : 0;
  return footprint;
}

std::vector<GhostFootprint> footprints_of(const LensState& lens, const std::vector<GhostFigures>& figures,
                                          const Light& light, const Frame& frame, const Context& context) {
  std::vector<std::size_t> chosen(figures.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  const std::size_t by_flux = std::min(kFootprintsByFlux, chosen.size());
  std::stable_sort(
      chosen.begin() + static_cast<std::ptrdiff_t>(by_flux), chosen.end(),
      [&](std::size_t a, std::size_t b) { return figures[a].peak_irradiance > figures[b].peak_irradiance; });
  chosen.resize(std::min(by_flux + kFootprintsByPeak, chosen.size()));
  std::vector<GhostFootprint> footprints;
  for (const GhostFigures& f : figures) footprints.push_back({f.ghost, {}, {}, {}});
  for (const std::size_t k : chosen)
    if (!context.cancelled()) footprints[k] = footprint_of(lens, figures[k].ghost, light, frame);
  return footprints;
}

}  // namespace contrejour::studio
