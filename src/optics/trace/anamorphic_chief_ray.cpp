// SPDX-License-Identifier: Apache-2.0
#include "optics/trace/anamorphic_chief_ray.h"

#include <algorithm>
#include <cmath>

#include "contrejour/expert/first_order.h"
#include "optics/trace/chief_newton.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFieldStep = 0.02;     // tangent
constexpr double kLargestField = 31.8;  // tangent of 88.2 degrees
constexpr int kSteps = 16;
constexpr double kLanded_mm = 1e-6;

Vec2 tangents_of(Vec3 direction) { return Vec2{direction.x, direction.y} * (1.0 / direction.z); }
Vec3 direction_of(Vec2 tangents) { return normalized(Vec3{tangents.x, tangents.y, 1.0}); }

Vec2 focal_lengths(const LensState& lens, double lambda_nm) {
  const FirstOrder figures = first_order(lens, lambda_nm);
  return {figures.focal_length_x_mm, figures.focal_length_mm};
}

Vec2 stretched(Vec2 focal_mm, Vec2 tangents) { return {focal_mm.x * tangents.x, focal_mm.y * tangents.y}; }

}  // namespace

bool is_anamorphic(const LensState& lens) {
  return !std::all_of(lens.surfaces.begin(), lens.surfaces.end(),
                      [](const SurfaceState& s) { return s.shape.has_axial_symmetry(); });
}

// Aims chief rays from the axis outwards, each from a first guess extrapolated from its neighbours. Beyond the last
// chief ray the image point is extrapolated by first-order optics.
Vec2 anamorphic_image_point(const LensState& lens, const LightSource& source, double lambda_nm) {
  const OpticalPath path = direct_path(lens, lambda_nm);
  const Vec2 target = tangents_of(source.direction);
  const int steps = std::max(1, static_cast<int>(std::ceil(std::min(length(target), kLargestField) / kFieldStep)));
  Vec2 image_mm, at_mm, before_mm;
  for (int k = 0; k <= steps; ++k) {
    const Vec2 tangents = target * (static_cast<double>(k) / steps);
    const auto chief = aim_chief(path, {direction_of(tangents), source.distance_mm}, at_mm + (at_mm - before_mm));
    if (!chief) {
      const Vec2 last = target * (std::max(0.0, k - 1.0) / steps);
      return image_mm + stretched(focal_lengths(lens, lambda_nm), target - last);
    }
    image_mm = chief->image_mm;
    before_mm = k == 0 ? chief->at_mm : at_mm;
    at_mm = chief->at_mm;
  }
  return image_mm;
}

// Secant steps (Broyden 1965, eq. 4.5, on the inverse) from the first order's map of tangents to the sensor.
Vec3 anamorphic_direction(const LensState& lens, Vec2 sensor_mm, double lambda_nm, double distance_mm) {
  const Vec2 focal_mm = focal_lengths(lens, lambda_nm);
  Vec2 per_x{1.0 / focal_mm.x, 0.0}, per_y{0.0, 1.0 / focal_mm.y};  // columns: tangents per mm
  const auto step_for = [&](Vec2 off_mm) { return per_x * off_mm.x + per_y * off_mm.y; };
  Vec2 tangents = step_for(sensor_mm);
  Vec2 off_mm = sensor_mm - chief_ray_image_point(lens, {direction_of(tangents), distance_mm}, lambda_nm);
  for (int k = 0; k < kSteps && length(off_mm) >= kLanded_mm; ++k) {
    const Vec2 step = step_for(off_mm);
    const Vec2 next = tangents + step;
    if (!(length(next) < kLargestField)) break;
    const Vec2 still_off_mm = sensor_mm - chief_ray_image_point(lens, {direction_of(next), distance_mm}, lambda_nm);
    const Vec2 moved_mm = off_mm - still_off_mm;
    const Vec2 predicted = step_for(moved_mm);
    const double scale = dot(step, predicted);
    if (std::abs(scale) > 0.0) {
      const Vec2 correction = (step - predicted) * (1.0 / scale);
      const Vec2 row{dot(step, per_x), dot(step, per_y)};
      per_x = per_x + correction * row.x;
      per_y = per_y + correction * row.y;
    }
    tangents = next;
    off_mm = still_off_mm;
  }
  return direction_of(tangents);
}

}  // namespace contrejour::inline internal
