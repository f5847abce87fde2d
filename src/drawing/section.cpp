// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/lens_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/trace.h"
#include "contrejour/light.h"
#include "drawing/section_shapes.h"

namespace contrejour {
namespace {

constexpr int kTriedRays = 2001;  // rays that are tried across the entrance window
constexpr int kImagingRays = 5;
constexpr int kRaysOfSingleGhost = 9, kRaysOfEachGhost = 5;
constexpr double kLeadingSpace = 0.10;    // space in front of the lens, relative to its length
constexpr double kGhostLightField = 0.33;

struct TriedRay {
  double y_mm = 0;
  bool open = false;
};

// The heights at which a ray is not blocked, or if all are blocked, those at which it reaches the sensor.
std::vector<TriedRay> rays_that_pass(const OpticalPath& path, const EntranceWindow& window, Vec3 direction) {
  std::vector<TriedRay> rays;
  for (int k = 0; k < kTriedRays; ++k) {
    const double y = std::lerp(window.min_mm.y, window.max_mm.y, static_cast<double>(k) / (kTriedRays - 1));
    const TracedRay ray = trace(path, {{0.0, y, window.z_mm}, direction});
    if (ray.status == RayStatus::Ok) rays.push_back({y, blocked_by(ray, path, Iris{}) <= 0.0});
  }
  const bool any_open = std::any_of(rays.begin(), rays.end(), [](const TriedRay& tried) { return tried.open; });
  if (any_open) std::erase_if(rays, [](const TriedRay& tried) { return !tried.open; });
  return rays;
}

SectionRay record(const OpticalPath& path, Vec3 origin, Vec3 direction, double left_mm) {
  SectionRay ray;
  ray.points_mm.push_back({left_mm, origin.y + (left_mm - origin.z) * direction.y / direction.z});
  const RayRecord traced = trace_recorded(path, {origin, direction});
  for (const TraceStep& step : traced.steps) {
    ray.points_mm.push_back({step.position_mm.z, step.position_mm.y});
    if (step.event == PathEvent::Reflect) ray.reflections_mm.push_back(ray.points_mm.back());
  }
  if (traced.ray.status == RayStatus::Ok) ray.points_mm.push_back({path.sensor_z_mm, traced.ray.sensor_mm.y});
  return ray;
}

// Adds `count` rays, evenly spaced over those that pass.
void add_fan(LensSection& section, const OpticalPath& path, Vec3 direction, SectionRayKind kind, int count,
             std::size_t ghost = 0) {
  const EntranceWindow window = entrance_window(section.lens, direction);
  const std::vector<TriedRay> passing = rays_that_pass(path, window, direction);
  if (passing.empty()) return;
  for (int k = 0; k < count; ++k) {
    const double at = static_cast<double>(k) / (count - 1) * static_cast<double>(passing.size() - 1);
    const TriedRay& chosen = passing[static_cast<std::size_t>(std::lround(at))];
    SectionRay ray = record(path, {0.0, chosen.y_mm, window.z_mm}, direction, section.left_mm);
    ray.kind = kind;
    ray.ghost = ghost;
    ray.blocked = !chosen.open;
    section.rays.push_back(std::move(ray));
  }
}

double half_diagonal_mm(const LensState& lens) { return 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm); }

void set_bounds(LensSection& section) {
  const LensState& lens = section.lens;
  double leftmost = 0.0;
  double highest = half_diagonal_mm(lens);
  for (const SurfaceState& s : lens.surfaces) {
    const double height = drawn_height_mm(s);
    leftmost = std::min(leftmost, s.z_mm + std::min(0.0, sag_mm(s, height)));
    highest = std::max(highest, height);
  }
  section.left_mm = leftmost - kLeadingSpace * (lens.sensor_z_mm - leftmost);
  section.right_mm = lens.sensor_z_mm;
  section.half_height_mm = 1.06 * highest;
}

// A surface without a real rim is drawn as large as the sensor.
LensState as_drawn(LensState lens) {
  for (SurfaceState& s : lens.surfaces)
    if (!has_real_rim(lens, s)) s.semi_diameter_mm = half_diagonal_mm(lens);
  return lens;
}

void add_rays_of_ghosts(LensSection& section, const LensState& lens, const SectionRequest& request, Vec3 light) {
  add_fan(section, direct_path(lens, request.lambda_nm), light, SectionRayKind::Axis, kImagingRays);
  const int rays = request.ghosts.size() > 1 ? kRaysOfEachGhost : kRaysOfSingleGhost;
  for (std::size_t g = 0; g < request.ghosts.size(); ++g) {
    if (!has_ghost(lens, request.ghosts[g])) continue;
    add_fan(section, ghost_path(lens, request.ghosts[g], request.lambda_nm), light, SectionRayKind::Ghost, rays, g);
  }
}

}  // namespace

bool has_real_rim(const LensState& lens, const SurfaceState& surface) {
  constexpr double kFarBeyond = 20.0;  // half diagonals
  return surface.semi_diameter_mm <= kFarBeyond * half_diagonal_mm(lens);
}

LensSection lens_section(const LensState& lens, const SectionRequest& request) {
  LensSection section;
  section.lens = as_drawn(lens);
  if (!check_lens(lens)) return section;
  add_shapes(section);
  section.ghosts = request.ghosts;
  set_bounds(section);
  const Vec3 field = direction_for_image_point(lens, {0.0, -half_diagonal_mm(lens)}, request.lambda_nm);
  if (request.ghosts.empty()) {
    const OpticalPath direct = direct_path(lens, request.lambda_nm);
    add_fan(section, direct, field, SectionRayKind::Field, kImagingRays);
    add_fan(section, direct, {0.0, 0.0, 1.0}, SectionRayKind::Axis, kImagingRays);
    return section;
  }
  const double light_rad =
      request.ghost_light_rad.value_or(kGhostLightField * angles_from_direction(field).elevation_rad);
  section.ghost_light_deg = light_rad * 180.0 / std::numbers::pi;
  add_rays_of_ghosts(section, lens, request, direction_from_angles(0.0, light_rad));
  return section;
}

}  // namespace contrejour
