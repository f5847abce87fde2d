// SPDX-License-Identifier: Apache-2.0
// The scalar tracer's steps: one ray in double precision, from surface to surface. trace.cpp says what a ray is;
// trace_rays.cpp has its loop over many beside these functions, so that a ray's numbers stay in registers. Passing them
// through memory, stored one by one and read in pairs, cost a twelfth of the time of a ray. Thread-safety: pure.
#pragma once

#include <algorithm>
#include <cmath>

#include "contrejour/expert/trace.h"
#include "optics/surface/shape-inl.h"
#include "optics/surface/surface-inl.h"

namespace contrejour::inline internal::scalar_trace {

namespace hk = kernels::HWY_NAMESPACE;

// Relative height of a ray that meets a sphere beyond its equator: it has left the glass and counts as blocked,
// whatever its distance from the axis.
inline constexpr double kBeyondEquator = 2.0;

struct State {
  hk::Ray3<double> ray;
  TracedRay out;
  int crossings = 0;
};

// The intersection of a ray with a step's surface, in the lens's coordinates (the sag from the vertex) and in the
// surface's own frame.
struct Meeting {
  hk::Hit<double> hit;
  double vertex_z_mm = 0;
  hk::SurfaceFramePoint<double> own;
};

// The vertex is the origin of the ray's and the hit's coordinates.
HWY_INLINE Meeting meet_tilted_shape(hk::Ray3<double> ray, const PathStep& step, const hk::Axis3<double>& axis) {
  hk::rotate_to_surface_frame(axis, ray.x, ray.y, ray.z);
  hk::rotate_to_surface_frame(axis, ray.dx, ray.dy, ray.dz);
  Meeting m{
      hk::intersect_shape(ray, 0.0, *step.shape, static_cast<double>(step.direction), hk::exact_limits(*step.shape)),
      0.0,
      {}};
  m.own = {m.hit.x, m.hit.y, m.hit.nz};
  hk::rotate_back(axis, m.hit.x, m.hit.y, m.hit.sag);
  hk::rotate_back(axis, m.hit.nx, m.hit.ny, m.hit.nz);
  return m;
}

HWY_INLINE Meeting meet(const hk::Ray3<double>& ray, const PathStep& step, bool centred) {
  const double direction = step.direction;
  if (centred) {
    const auto hit = step.shape
                         ? hk::intersect_shape(ray, step.z_mm, *step.shape, direction, hk::exact_limits(*step.shape))
                         : hk::intersect(ray, step.z_mm, step.curvature_per_mm, direction);
    return {hit, step.z_mm, {hit.x, hit.y, hit.nz}};
  }
  const Vec3 vertex = step.pose.shift_mm + Vec3{0.0, 0.0, step.z_mm};
  const hk::Axis3<double> axis{step.pose.axis.x, step.pose.axis.y, step.pose.axis.z};
  hk::Ray3<double> from_vertex = ray;
  from_vertex.x -= vertex.x;
  from_vertex.y -= vertex.y;
  from_vertex.z -= vertex.z;
  Meeting m;
  if (step.shape) {
    m = meet_tilted_shape(from_vertex, step, axis);
  } else {
    m.hit = hk::intersect_tilted(from_vertex, axis, step.curvature_per_mm, direction);
    m.own = hk::surface_frame_point(m.hit, axis, step.curvature_per_mm);
  }
  m.vertex_z_mm = vertex.z;
  m.hit.x += vertex.x;
  m.hit.y += vertex.y;
  return m;
}

HWY_INLINE double distance_over_rim(const hk::SurfaceFramePoint<double>& own, const PathStep& step) {
  const double r = length(step.rim_point({own.x, own.y}));
  return own.nz > 0.0 ? r : std::max(r, kBeyondEquator);
}

// A grating perpendicular to the axis adds to the direction's x and y; false if the result is evanescent.
HWY_INLINE bool deflect_by_grating(State& state, Vec2 grating_shift) {
  hk::Ray3<double>& ray = state.ray;
  ray.dx += grating_shift.x;
  ray.dy += grating_shift.y;
  const double along_squared = 1.0 - ray.dx * ray.dx - ray.dy * ray.dy;
  if (!(along_squared > 0.0)) {
    state.out.status = RayStatus::Missed;
    return false;
  }
  ray.dz = std::copysign(std::sqrt(along_squared), ray.dz);
  return true;
}

// Takes the ray across one surface; false ends it with out.status set. The functions that it calls are inlined, as
// compilers do where a function has one caller: without that, tracing took a twentieth longer.
inline bool advance(State& state, const PathStep& step, const OpticalPath& path, double* angle_of_incidence_rad,
                    double* reflectance_here) {
  const double direction = step.direction;
  const Meeting met = meet(state.ray, step, path.centred);
  const auto& hit = met.hit;
  if (!(hit.cos_in_squared > 0.0)) {
    state.out.status = RayStatus::Missed;
    return false;
  }
  const double from_z_mm = state.ray.z;
  hk::move_to(state.ray, hit, met.vertex_z_mm);
  if (step.absorption_per_mm != 0.0)
    state.out.transmission *= std::exp(-step.absorption_per_mm * (state.ray.z - from_z_mm) / state.ray.dz);
  if (angle_of_incidence_rad != nullptr) *angle_of_incidence_rad = std::acos(std::min(1.0, hit.cos_in));
  if (step.event == PathEvent::Stop) {
    if (state.crossings < kMaxStopCrossings)
      state.out.stop[static_cast<std::size_t>(state.crossings++)] =
          Vec2{met.own.x, met.own.y} * (1.0 / path.stop_radius_mm);
    return true;
  }
  const double distance = distance_over_rim(met.own, step);
  if (step.blocks_within) {
    state.out.obscured = std::max(state.out.obscured, 1.0 - distance);
  } else {
    state.out.relative_height = std::max(state.out.relative_height, distance);
  }
  const double cos_in = std::min(1.0, hit.cos_in);
  const double r = reflectance(step.coating, step.n_in, step.n_out, cos_in, path.lambda_nm);
  if (reflectance_here != nullptr) *reflectance_here = r;
  if (step.event == PathEvent::Reflect) {
    hk::reflect(state.ray, hit, direction);
    state.out.transmission *= r * step.efficiency;
    return step.grating_shift == Vec2{} || deflect_by_grating(state, step.grating_shift);
  }
  if (hk::refract(state.ray, hit, step.n_in / step.n_out, direction) <= 0.0) {
    state.out.status = RayStatus::TotalReflection;
    return false;
  }
  state.out.transmission *=
      may_absorb(step.coating) ? transmittance(step.coating, step.n_in, step.n_out, cos_in, path.lambda_nm) : 1.0 - r;
  return true;
}

HWY_INLINE bool is_finite(const Ray& ray) {
  const Vec3 o = ray.origin_mm;
  const Vec3 d = ray.direction;
  return std::isfinite(o.x + o.y + o.z) && std::isfinite(d.x + d.y + d.z) && d.z != 0.0;
}

HWY_INLINE State start(const Ray& ray) {
  State state;
  state.ray = {ray.origin_mm.x, ray.origin_mm.y, ray.origin_mm.z, ray.direction.x, ray.direction.y, ray.direction.z};
  state.out.transmission = 1.0;
  if (!is_finite(ray)) state.out.status = RayStatus::NotFinite;
  return state;
}

HWY_INLINE void land(State& state, double sensor_z_mm) {
  const auto& ray = state.ray;
  const double t = (sensor_z_mm - ray.z) / ray.dz;
  state.out.sensor_mm = {ray.x + t * ray.dx, ray.y + t * ray.dy};
  state.out.direction = {ray.dx, ray.dy, ray.dz};
  if (!(ray.dz > 0.0)) state.out.status = RayStatus::Missed;
}

HWY_INLINE void fail_dark(TracedRay& ray) {
  if (ray.status != RayStatus::Ok) ray.transmission = 0.0;
}

// A ray from its start to the sensor.
inline State trace_all(const OpticalPath& path, const Ray& ray) {
  State state = start(ray);
  if (state.out.status == RayStatus::Ok) {
    bool alive = true;
    for (auto step = path.steps.begin(); alive && step != path.steps.end(); ++step) {
      alive = advance(state, *step, path, nullptr, nullptr);
    }
    if (alive) land(state, path.sensor_z_mm);
  }
  fail_dark(state.out);
  return state;
}

}  // namespace contrejour::inline internal::scalar_trace
