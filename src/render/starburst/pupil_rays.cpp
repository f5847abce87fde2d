// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/pupil_rays.h"

#include <algorithm>

#include "base/tasks.h"
#include "optics/trace/height_vector.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal {
namespace {

constexpr int kSide = 41;
constexpr double kBeyond = 0.08;  // of the region, added on each side: borders are fitted from both sides

// The region in which the direct image's rays enter. It does not depend on coatings, and bare surfaces are tabulated
// faster.
std::optional<Rectangle> find_region(LensState lens, const LightSource& light, double lambda_nm) {
  for (SurfaceState& surface : lens.surfaces) surface.coating = {};
  const ReflectanceTables tables(lens, lambda_nm);
  const pupils::PupilRays rays(direct_path(lens, lambda_nm), tables, light, IrisShape(lens.iris),
                               entrance_window(lens, light));
  const pupils::Pupil found = find_pupil(rays, {});
  if (found.is_empty()) return std::nullopt;
  const Vec2 beyond = (found.box().high - found.box().low) * kBeyond;
  return Rectangle{found.box().low - beyond, found.box().high + beyond};
}

// Traces one ray, and writes its points at the rims: rim_points[rim * stride].
PupilRay trace_one(const OpticalPath& path, const IrisOpening& iris, const Ray& from, Vec2* rim_points,
                   std::size_t stride) {
  PupilRay ray;
  ray.entrance_mm = {from.origin_mm.x, from.origin_mm.y};
  const RayRecord record = trace_recorded(path, from);
  if (record.ray.status != RayStatus::Ok) return ray;
  ray.arrived = true;
  ray.cosines = {record.ray.direction.x, record.ray.direction.y};
  ray.stop = record.ray.stop[0];
  ray.transmission = record.ray.transmission;
  ray.iris = iris.bound_distance(ray.stop);
  ray.blocked = std::max(ray.iris, record.ray.relative_height - 1.0);
  ray.obscured = record.ray.obscured;
  std::size_t rim = 0;
  for (std::size_t k = 0; k < path.steps.size(); ++k) {
    if (path.steps[k].event == PathEvent::Stop) continue;
    const Vec2 at = height_vector(path.steps[k], record.steps[k].position_mm);
    rim_points[rim++ * stride] = path.steps[k].rim_point(at);
  }
  return ray;
}

}  // namespace

std::optional<PupilRays> trace_pupil(const LensState& lens, const IrisOpening& iris, const LightSource& light,
                                     double lambda_nm, const Context& context) {
  const auto box = find_region(lens, light, lambda_nm);
  if (!box) return std::nullopt;
  const OpticalPath path = direct_path(lens, lambda_nm);
  PupilRays pupil;
  pupil.side = kSide;
  pupil.z_mm = entrance_window(lens, light).z_mm;
  pupil.rims = path.steps.size() - static_cast<std::size_t>(path.stop_crossings);
  for (const PathStep& step : path.steps)
    if (step.event != PathEvent::Stop) pupil.blocks_within.push_back(step.blocks_within);
  pupil.rays.resize(static_cast<std::size_t>(kSide) * kSide);
  pupil.rim_points.resize(pupil.rims * pupil.rays.size());
  const Vec2 step = (box->high - box->low) * (1.0 / (kSide - 1));
  const bool done = parallel_for(static_cast<std::size_t>(kSide), context, [&](std::size_t row) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(kSide); ++column) {
      const std::size_t k = row * static_cast<std::size_t>(kSide) + column;
      const Vec2 at = box->low + Vec2{static_cast<double>(column) * step.x, static_cast<double>(row) * step.y};
      const Vec3 from{at.x, at.y, pupil.z_mm};
      pupil.rays[k] =
          trace_one(path, iris, {from, light.direction_at(from)}, pupil.rim_points.data() + k, pupil.rays.size());
      pupil.rays[k].transmission *= light.flux_at(from);
    }
  });
  if (!done) return std::nullopt;
  return pupil;
}

}  // namespace contrejour::inline internal
