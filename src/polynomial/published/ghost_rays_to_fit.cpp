// SPDX-License-Identifier: Apache-2.0
#include "polynomial/published/ghost_rays_to_fit.h"

#include <algorithm>
#include <cmath>

#include "contrejour/expert/iris.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kOpeningGrid = 128;
constexpr double kRayMargin = 1.5;  // of the stop and the rims: the corners of a box lie so far out
constexpr double kBoxMargin = 0.2;  // of the opening, around it
constexpr double kInputScale = 2.0;  // of the first surface's rim, so that inputs lie within 1 for inclined light

Vec3 direction_of(Vec2 light) { return normalized({light.x, light.y, 1.0}); }

bool nearly_passes(const TracedRay& ray, int crossings) {
  if (ray.status != RayStatus::Ok || ray.relative_height > kRayMargin) return false;
  for (int k = 0; k < crossings; ++k)
    if (length(ray.stop[static_cast<std::size_t>(k)]) > kRayMargin) return false;
  return true;
}

}  // namespace

Vec2 GhostToFit::normalised(Vec2 entrance_mm) const {
  return entrance_mm * (1.0 / (kInputScale * lens_.surfaces.front().semi_diameter_mm));
}

TracedRay GhostToFit::trace_at(Vec2 light, Vec2 entrance_mm) const {
  return trace(path_, {{entrance_mm.x, entrance_mm.y, 0.0}, direction_of(light)});
}

bool GhostToFit::passes(const TracedRay& ray) const {
  return ray.status == RayStatus::Ok && blocked_by(ray, path_, lens_.iris) <= 0.0;
}

std::optional<Rectangle> GhostToFit::opening(Vec2 light) const {
  const double half_mm = 1.5 * lens_.surfaces.front().semi_diameter_mm;
  const auto coordinate = [&](int k) { return ((k + 0.5) / kOpeningGrid * 2.0 - 1.0) * half_mm; };
  std::optional<Rectangle> box;
  for (int iy = 0; iy < kOpeningGrid; ++iy) {
    for (int ix = 0; ix < kOpeningGrid; ++ix) {
      const Vec2 at{coordinate(ix), coordinate(iy)};
      if (passes(trace_at(light, at))) box = box ? both(*box, Rectangle{at, at}) : Rectangle{at, at};
    }
  }
  if (!box) return std::nullopt;
  const double step_mm = 2.0 * half_mm / kOpeningGrid;
  return Rectangle{box->low - Vec2{step_mm, step_mm}, box->high + Vec2{step_mm, step_mm}};
}

std::array<published::Samples, 5> GhostToFit::samples(const published::PictureOptions& options, Vec2 light) const {
  std::array<published::Samples, 5> all;
  const auto found = opening(light);
  if (!found) return all;
  const Vec2 middle = 0.5 * (found->low + found->high);
  const Vec2 half = (0.5 + kBoxMargin) * (found->high - found->low);
  SeededRandom random(options.seed);
  for (int tried = 0; tried < 50 * options.samples; ++tried) {
    if (static_cast<int>(all[0].values.size()) == options.samples) break;
    const Vec2 turn{2.0 * random.unit() - 1.0, 2.0 * random.unit() - 1.0};
    const Vec2 at = middle + Vec2{half.x * (2.0 * random.unit() - 1.0), half.y * (2.0 * random.unit() - 1.0)};
    const TracedRay ray = trace_at(light + options.half_range * turn, at);
    const Vec2 place = normalised(at);
    if (!nearly_passes(ray, path_.stop_crossings) || std::max(std::abs(place.x), std::abs(place.y)) > 1.0) continue;
    const std::array values{ray.sensor_mm.x, ray.sensor_mm.y, ray.stop[0].x, ray.stop[0].y, ray.transmission};
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].inputs.push_back({turn.x, turn.y, place.x, place.y});
      all[k].values.push_back(values[k]);
    }
  }
  return all;
}

}  // namespace contrejour::inline internal::polynomial
