// SPDX-License-Identifier: Apache-2.0
#include "polynomial/direct_rays.h"

#include <algorithm>
#include <cmath>

#include "optics/trace/path_steps.h"
#include "optics/trace/scalar_trace-inl.h"

namespace contrejour::inline internal::polynomial {
namespace {

// The steps of direct_path() in reverse.
OpticalPath reversed_path(const LensState& lens, double lambda_nm, double front_z_mm) {
  OpticalPath path = direct_path(lens, lambda_nm);
  path.steps.clear();
  path.stop_crossings = 0;
  path.sensor_z_mm = front_z_mm;
  for (std::size_t k = lens.surfaces.size(); k-- > 0;)
    if (lens.surfaces[k].kind != SurfaceKind::Sensor)
      add_steps(path, lens, static_cast<int>(k), -1, PathEvent::Refract);
  return path;
}

// The steps up to the stop, uncoated, as only the ray's path counts.
OpticalPath path_to_stop(const OpticalPath& whole) {
  OpticalPath path = whole;
  const auto stop = std::ranges::find(path.steps, PathEvent::Stop, &PathStep::event);
  path.steps.erase(stop == path.steps.end() ? stop : stop + 1, path.steps.end());
  for (PathStep& step : path.steps) step.coating = {};
  return path;
}

std::optional<Vec3> backwards(Vec2 xy) {
  const double rest = 1.0 - dot(xy, xy);
  if (!(rest > 0.0)) return std::nullopt;
  return Vec3{xy.x, xy.y, -std::sqrt(rest)};
}

}  // namespace

CameraRays::CameraRays(const LensState& lens, double lambda_nm, double front_z_mm)
    : whole_(reversed_path(lens, lambda_nm, front_z_mm)), to_stop_(path_to_stop(whole_)),
      sensor_z_mm_(lens.sensor_z_mm), stop_z_mm_(lens.surfaces[static_cast<std::size_t>(lens.stop_index)].z_mm) {}

Vec2 CameraRays::straight(Vec2 sensor_mm, Vec2 stop) const {
  const Vec2 across = stop * whole_.stop_radius_mm - sensor_mm;
  return across * (1.0 / std::hypot(across.x, across.y, stop_z_mm_ - sensor_z_mm_));
}

std::optional<Vec2> CameraRays::stop_point(Vec2 sensor_mm, Vec2 inner) const {
  const auto direction = backwards(inner);
  if (!direction) return std::nullopt;
  auto state = scalar_trace::start({{sensor_mm.x, sensor_mm.y, sensor_z_mm_}, *direction});
  for (const PathStep& step : to_stop_.steps)
    if (!scalar_trace::advance(state, step, to_stop_, nullptr, nullptr)) return std::nullopt;
  return state.out.stop[0];
}

std::optional<Vec2> CameraRays::aimed(Vec2 sensor_mm, Vec2 stop, Vec2 start) const {
  constexpr int kMaxSteps = 30, kMaxStepHalvings = 8;
  constexpr double kConverged = 1e-10, kDifference = 1e-6;  // stop radii; direction
  Vec2 at = start;
  auto found = stop_point(sensor_mm, at);
  for (int k = 0; k < kMaxSteps && found; ++k) {
    const Vec2 miss = stop - *found;
    if (length(miss) < kConverged) return at;
    const auto right = stop_point(sensor_mm, at + Vec2{kDifference, 0.0});
    const auto up = stop_point(sensor_mm, at + Vec2{0.0, kDifference});
    if (!right || !up) return std::nullopt;
    const Vec2 by_x = (*right - *found) * (1.0 / kDifference), by_y = (*up - *found) * (1.0 / kDifference);
    Vec2 step = Vec2{cross(miss, by_y), cross(by_x, miss)} * (1.0 / cross(by_x, by_y));
    bool better = false;
    for (int halving = 0; halving < kMaxStepHalvings && !better; ++halving, step = step * 0.5) {
      const auto next = stop_point(sensor_mm, at + step);
      better = next && length(stop - *next) < length(miss);
      if (!better) continue;
      at = at + step;
      found = next;
      break;
    }
    if (!better) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<CameraRay> CameraRays::trace_from(Vec2 sensor_mm, Vec2 inner) const {
  const auto direction = backwards(inner);
  if (!direction) return std::nullopt;
  auto state = scalar_trace::start({{sensor_mm.x, sensor_mm.y, sensor_z_mm_}, *direction});
  CameraRay ray;
  ray.rim_squared.resize(whole_.steps.size(), 0.0);
  for (std::size_t k = 0; k < whole_.steps.size(); ++k) {
    const PathStep& step = whole_.steps[k];
    if (!scalar_trace::advance(state, step, whole_, nullptr, nullptr)) return std::nullopt;
    if (step.event == PathEvent::Stop) continue;
    const Vec2 rim = step.rim_point({state.ray.x, state.ray.y});
    ray.rim_squared[whole_.steps.size() - 1 - k] = dot(rim, rim);
  }
  // The tracer lands rays that travel to +z alone.
  if (!(state.ray.dz < 0.0)) return std::nullopt;
  const double along = (whole_.sensor_z_mm - state.ray.z) / state.ray.dz;
  ray.origin_mm = {state.ray.x + along * state.ray.dx, state.ray.y + along * state.ray.dy};
  ray.direction = {state.ray.dx, state.ray.dy};
  ray.inner = inner;
  ray.transmittance = state.out.transmission;
  ray.largest_height = state.out.relative_height;
  return ray;
}

}  // namespace contrejour::inline internal::polynomial
