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
  Vec2 entrance_mm;
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

// A ghost's rays from a light.
struct GhostRays {
  const LensState& lens;
  OpticalPath path;
  LightSource source;
  double z_mm;  // of the entrance plane

  [[nodiscard]] Landing from(Vec2 entrance_mm) const {
    const Vec3 point{entrance_mm.x, entrance_mm.y, z_mm};
    const TracedRay ray = trace(path, {point, source.direction_at(point)});
    if (ray.status != RayStatus::Ok) return {entrance_mm, false, {}, 1.0, 0.0};
    return {entrance_mm, true, ray.sensor_mm, blocked_by(ray, path, lens.iris), ray.transmission};
  }
};

Landings land(const GhostRays& rays, const Window& window) {
  Landings landings;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) landings.push_back(rays.from(window.at(column, row)));
  return landings;
}

// A point of the pupil's border, between a lit ray and one that is not.
struct Crossing {
  double part;  // of the way from the lit one
  Vec2 sensor_mm;
};

// Interpolates linearly how far the rays are blocked, or halves the way where the dark one does not reach the sensor.
Crossing crossing_between(const Landing& lit, const Landing& dark, const GhostRays& rays) {
  constexpr int kHalvings = 6;
  if (dark.is_ray) {
    const double part = lit.blocked / (lit.blocked - dark.blocked);
    return {part, lit.sensor_mm + (dark.sensor_mm - lit.sensor_mm) * part};
  }
  Crossing last{0.0, lit.sensor_mm};
  double step = 0.5;
  for (int k = 0; k < kHalvings; ++k, step *= 0.5) {
    const Landing next = rays.from(lit.entrance_mm + (dark.entrance_mm - lit.entrance_mm) * (last.part + step));
    if (next.is_lit()) last = {last.part + step, next.sensor_mm};
  }
  return last;
}

// The part of the window that has all rays that get through, and a cell more on each side.
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

// Extends the window beyond each side that has lit rays, within the whole: a tip of the pupil may lie between two rays
// of a coarse grid.
Window widened(const Landings& landings, const Window& window, const Window& whole) {
  constexpr double kByPart = 0.25;
  const auto is_lit = [&](int column, int row) { return at(landings, column, row).is_lit(); };
  bool left = false, right = false, top = false, bottom = false;
  for (int k = 0; k < kSide; ++k) {
    left = left || is_lit(0, k);
    right = right || is_lit(kSide - 1, k);
    top = top || is_lit(k, 0);
    bottom = bottom || is_lit(k, kSide - 1);
  }
  const Vec2 by = (window.max - window.min) * kByPart;
  return {{std::fmax(whole.min.x, window.min.x - (left ? by.x : 0)),
           std::fmax(whole.min.y, window.min.y - (top ? by.y : 0))},
          {std::fmin(whole.max.x, window.max.x + (right ? by.x : 0)),
           std::fmin(whole.max.y, window.max.y + (bottom ? by.y : 0))}};
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

// Extends the window until it contains the whole pupil, and traces its rays.
Landings landings_within(const GhostRays& rays, Window window, const Window& whole) {
  constexpr int kMostSteps = 4;
  Landings landings = land(rays, window);
  for (int k = 0; k < kMostSteps; ++k) {
    const Window wider = widened(landings, window, whole);
    if (wider.min == window.min && wider.max == window.max) break;
    window = wider;
    landings = land(rays, window);
  }
  return landings;
}

// The lit part of a cell: its lit corners, and the points between a lit and a blocked one where the border is. The
// cell's light is its area in the pupil, in cells, times its transmittance, until all are known.
void add_cell(const std::array<const Landing*, 4>& corners, const GhostRays& rays, const Frame& frame,
              GhostFootprint& footprint) {
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
    const Crossing border = here.is_lit() ? crossing_between(here, next, rays) : crossing_between(next, here, rays);
    const double part = here.is_lit() ? border.part : 1.0 - border.part;
    crossings.push_back(frame.pixel_from_sensor(border.sensor_mm));
    polygon.push_back(crossings.back());
    in_pupil.push_back(kPupilCorners[k] + (kPupilCorners[after] - kPupilCorners[k]) * part);
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
  const EntranceWindow entrance = entrance_window(lens, light.source());
  const GhostRays rays{lens, ghost_path(lens, ghost, lens.design_wavelength_nm), light.source(), entrance.z_mm};
  const Window whole{entrance.min_mm, entrance.max_mm};
  const auto lit = lit_part(land(rays, whole), whole);
  if (!lit) return footprint;
  const Landings landings = landings_within(rays, *lit, whole);
  for (int row = 0; row + 1 < kSide; ++row)
    for (int column = 0; column + 1 < kSide; ++column) {
      const std::array<const Landing*, 4> corners = {&at(landings, column, row), &at(landings, column + 1, row),
                                                     &at(landings, column + 1, row + 1),
                                                     &at(landings, column, row + 1)};
      if (std::ranges::any_of(corners, [](const Landing* corner) { return corner->is_lit(); }))
        add_cell(corners, rays, frame, footprint);
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
