// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/trace.h"

#include <algorithm>
#include <cmath>

#include "optics/trace/height_vector.h"
#include "optics/trace/scalar_trace-inl.h"

namespace contrejour {

const char* to_string(RayStatus status) {
  switch (status) {
    case RayStatus::Ok: return "ok";
    case RayStatus::Missed: return "missed";
    case RayStatus::TotalReflection: return "total_reflection";
    case RayStatus::NotFinite: return "not_finite";
  }
  return "unknown";
}

TracedRay trace(const OpticalPath& path, const Ray& ray) { return scalar_trace::trace_all(path, ray).out; }

}  // namespace contrejour

namespace contrejour::inline internal {

Vec2 height_vector(const PathStep& step, Vec3 position_mm) {
  const Vec3 from = position_mm - step.pose.shift_mm - Vec3{0.0, 0.0, step.z_mm};
  namespace hk = kernels::HWY_NAMESPACE;
  hk::Hit<double> hit{};
  hit.x = from.x;
  hit.y = from.y;
  hit.sag = from.z;
  const auto own =
      hk::surface_frame_point(hit, {step.pose.axis.x, step.pose.axis.y, step.pose.axis.z}, step.curvature_per_mm);
  return {own.x, own.y};
}

}  // namespace contrejour::inline internal

namespace contrejour {

RayRecord trace_recorded(const OpticalPath& path, const Ray& ray) {
  using namespace scalar_trace;
  State state = start(ray);
  RayRecord record;
  bool alive = state.out.status == RayStatus::Ok;
  for (auto step = path.steps.begin(); alive && step != path.steps.end(); ++step) {
    TraceStep recorded;
    recorded.surface = step->surface + 1;
    recorded.event = step->event;
    recorded.is_rim_only = step->is_rim_only;
    alive = advance(state, *step, path, &recorded.angle_of_incidence_rad, &recorded.reflectance);
    if (state.out.status == RayStatus::Missed) break;
    recorded.position_mm = {state.ray.x, state.ray.y, state.ray.z};
    recorded.direction_after = {state.ray.dx, state.ray.dy, state.ray.dz};
    record.steps.push_back(recorded);
  }
  if (alive) land(state, path.sensor_z_mm);
  fail_dark(state.out);
  record.ray = state.out;
  return record;
}

double blocked_by(const TracedRay& ray, const OpticalPath& path, const Iris& iris) {
  double worst = std::max(ray.relative_height - 1.0, ray.obscured);
  for (int k = 0; k < std::min(path.stop_crossings, kMaxStopCrossings); ++k) {
    worst = std::max(worst, iris_distance(iris, ray.stop[static_cast<std::size_t>(k)]));
  }
  return worst;
}

}  // namespace contrejour
