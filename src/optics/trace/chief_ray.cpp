// SPDX-License-Identifier: Apache-2.0
// Computes a light's image point by its chief ray. A lens with axial symmetry needs one meridian: a table of image
// height against field angle, computed outwards from the axis so that each chief ray starts from its neighbour's. Other
// lenses need a search in two dimensions: anamorphic_chief_ray.h for surfaces without axial symmetry, and a start from
// the centred lens's chief ray for decentred or tilted elements.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/trace.h"
#include "optics/trace/anamorphic_chief_ray.h"
#include "optics/trace/chief_newton.h"

namespace contrejour {
namespace {

constexpr double kFieldStep_rad = 0.005;
constexpr double kLastField_rad = 0.49 * std::numbers::pi;
constexpr int kFieldBisections = 60;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The field angle is that of the light's direction. Heights are in the plane of the paraxial entrance pupil if the
// pupil lies behind the light, else in that of the first vertex.
class Meridian {
 public:
  Meridian(const LensState& lens, double lambda_nm, double distance_mm)
      : path_(direct_path(lens, lambda_nm)), pupil_z_mm_(first_order(lens, lambda_nm).entrance_pupil_position_mm),
        distance_mm_(distance_mm) {
    if (!std::isfinite(pupil_z_mm_)) pupil_z_mm_ = 0.0;  // telecentric in object space: any plane serves
    if (!source_at(0.0).is_distant()) pupil_z_mm_ = std::max(pupil_z_mm_, 0.0);
  }

  struct Chief {
    double height_mm = 0;  // at that plane
    double image_mm = 0;
    double per_mm = 0;  // derivative of the stop coordinate by the height, stop radii; 0: unknown
  };

  // Secant search for the ray through the stop's centre, from a first guess.
  [[nodiscard]] std::optional<Chief> chief(double field_rad, const Chief& guess) const {
    constexpr double kFirstStep_mm = 1e-3;
    double height_mm = guess.height_mm, per_mm = guess.per_mm;
    TracedRay ray = at(field_rad, height_mm);
    for (int k = 0; k < kAimSteps && ray.status == RayStatus::Ok; ++k) {
      const double height = ray.stop[0].y;
      if (per_mm != 0.0 && std::abs(height) < kAimed) return Chief{height_mm, ray.sensor_mm.y, per_mm};
      const double step_mm = per_mm != 0.0 ? -height / per_mm : kFirstStep_mm;
      height_mm += step_mm;
      ray = at(field_rad, height_mm);
      per_mm = (ray.stop[0].y - height) / step_mm;
    }
    return std::nullopt;
  }

  // Needs no neighbours where the paraxial pupil gives a good start: the ray through its centre nearly meets the
  // stop's.
  [[nodiscard]] std::optional<Chief> chief_near_axis(double field_rad) const {
    constexpr double kNear = 0.05;  // stop radii
    const TracedRay first = at(field_rad, 0.0);
    if (first.status != RayStatus::Ok || std::abs(first.stop[0].y) > kNear) return std::nullopt;
    return chief(field_rad, {});
  }

  // The height at z = 0 of the ray at this height in the pupil's plane.
  [[nodiscard]] double height_at_vertex(double field_rad, double height_mm) const {
    const Vec3 d = source_at(field_rad).direction_at({0.0, height_mm, pupil_z_mm_});
    return height_mm - pupil_z_mm_ * d.y / d.z;
  }

 private:
  [[nodiscard]] LightSource source_at(double field_rad) const {
    return {{0.0, std::sin(field_rad), std::cos(field_rad)}, distance_mm_};
  }
  [[nodiscard]] TracedRay at(double field_rad, double height_mm) const {
    const Vec3 at{0.0, height_mm, pupil_z_mm_};
    return trace(path_, {at, source_at(field_rad).direction_at(at)});
  }

  OpticalPath path_;
  double pupil_z_mm_;
  double distance_mm_;
};

struct FieldPoint {
  double field_rad = 0;
  Meridian::Chief chief;
};

// Extrapolates with the parabola through the last three points.
Meridian::Chief next_guess(std::span<const FieldPoint> points) {
  Meridian::Chief guess = points.back().chief;
  const auto height_mm = [&](std::size_t back) { return points[points.size() - 1 - back].chief.height_mm; };
  if (points.size() >= 3) guess.height_mm += 2.0 * height_mm(0) - 3.0 * height_mm(1) + height_mm(2);
  return guess;
}

// Adds points up to the first that is far enough, or to the last angle whose chief ray exists and has a larger image
// height than the one before.
template <class FarEnough>
std::vector<FieldPoint> walk_field(const Meridian& meridian, FarEnough far_enough) {
  std::vector<FieldPoint> points{{0.0, {}}};
  for (double field = kFieldStep_rad; field < kLastField_rad; field += kFieldStep_rad) {
    const auto chief = meridian.chief(field, next_guess(points));
    if (!chief || !(std::abs(chief->image_mm) > std::abs(points.back().chief.image_mm))) break;
    points.push_back({field, *chief});
    if (far_enough(points.back())) break;
  }
  return points;
}

std::vector<FieldPoint> walk_past(const Meridian& meridian, double field_rad) {
  return walk_field(meridian, [&](const FieldPoint& point) { return point.field_rad > field_rad; });
}

// Beyond the last chief ray the image height is extrapolated in proportion to f tan(field).
double extrapolated_image_height(const LensState& lens, const FieldPoint& last, double field_rad) {
  return std::abs(last.chief.image_mm) +
         std::abs(lens.focal_length_mm) * (std::tan(field_rad) - std::tan(last.field_rad));
}

double image_height_at(const Meridian& meridian, const FieldPoint& near, double field_rad) {
  const auto chief = meridian.chief(field_rad, near.chief);
  return std::abs(chief ? chief->image_mm : near.chief.image_mm);
}

double field_for(const LensState& lens, double lambda_nm, double distance_mm, double radius_mm) {
  const Meridian meridian(lens, lambda_nm, distance_mm);
  const auto points =
      walk_field(meridian, [&](const FieldPoint& point) { return std::abs(point.chief.image_mm) > radius_mm; });
  const FieldPoint& last = points.back();
  if (radius_mm >= std::abs(last.chief.image_mm)) {
    return std::atan(std::tan(last.field_rad) +
                     (radius_mm - std::abs(last.chief.image_mm)) / std::abs(lens.focal_length_mm));
  }
  std::size_t k = 0;
  while (std::abs(points[k + 1].chief.image_mm) <= radius_mm) ++k;
  double low = points[k].field_rad;
  double high = points[k + 1].field_rad;
  for (int step = 0; step < kFieldBisections; ++step) {
    const double middle = 0.5 * (low + high);
    (image_height_at(meridian, points[k], middle) < radius_mm ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The chief ray's height at z = 0.
double chief_height_for(const LensState& lens, double lambda_nm, double distance_mm, double field_rad) {
  const Meridian meridian(lens, lambda_nm, distance_mm);
  const auto points = walk_past(meridian, field_rad);
  const auto k = std::min(static_cast<std::size_t>(field_rad / kFieldStep_rad), points.size() - 1);
  const auto chief = meridian.chief(field_rad, points[k].chief);
  return meridian.height_at_vertex(field_rad, chief ? chief->height_mm : points[k].chief.height_mm);
}

double radius_for(const LensState& lens, double lambda_nm, double distance_mm, double field_rad) {
  const Meridian meridian(lens, lambda_nm, distance_mm);
  if (const auto chief = meridian.chief_near_axis(field_rad)) return std::abs(chief->image_mm);
  const auto points = walk_past(meridian, field_rad);
  if (field_rad >= points.back().field_rad) return extrapolated_image_height(lens, points.back(), field_rad);
  const auto k = static_cast<std::size_t>(field_rad / kFieldStep_rad);
  return image_height_at(meridian, points[std::min(k, points.size() - 1)], field_rad);
}

// Chief rays ignore rims, so only poses matter.
bool is_centred(const LensState& lens) {
  return std::all_of(lens.surfaces.begin(), lens.surfaces.end(), [](const SurfaceState& s) { return s.is_centred(); });
}

// The lens without decentres and tilts, for first guesses.
LensState centred(LensState lens) {
  for (SurfaceState& s : lens.surfaces) s.pose = {};
  return lens;
}

// Fixed-point iteration: the centred lens gives the direction for a target point, which is moved by the remaining error
// of the real lens's image point.
Vec3 direction_of_displaced_lens(const LensState& lens, Vec2 sensor_mm, double lambda_nm, double distance_mm) {
  constexpr int kSteps = 8;
  constexpr double kLanded_mm = 1e-6;
  const LensState ideal = centred(lens);
  Vec2 target_mm = sensor_mm;
  Vec3 direction = direction_for_image_point(ideal, target_mm, lambda_nm, distance_mm);
  for (int k = 0; k < kSteps; ++k) {
    const Vec2 off_mm = sensor_mm - chief_ray_image_point(lens, {direction, distance_mm}, lambda_nm);
    if (length(off_mm) < kLanded_mm) break;
    target_mm = target_mm + off_mm;
    direction = direction_for_image_point(ideal, target_mm, lambda_nm, distance_mm);
  }
  return direction;
}

// Its chief rays go straight through the middle.
bool is_ideal_lens(const LensState& lens) { return lens.surfaces.empty() && lens.focal_length_mm > 0.0; }

}  // namespace

// A positive lens images a distant light on the side of the sensor to which its direction of travel d points.
Vec3 direction_for_image_point(const LensState& lens, Vec2 sensor_mm, double lambda_nm, double distance_mm) {
  if (is_ideal_lens(lens)) return normalized(Vec3{sensor_mm.x, sensor_mm.y, lens.focal_length_mm});
  if (!has_stop(lens) || !std::isfinite(sensor_mm.x + sensor_mm.y)) return {kNan, kNan, kNan};
  if (is_anamorphic(lens)) return anamorphic_direction(lens, sensor_mm, lambda_nm, distance_mm);
  if (!is_centred(lens)) return direction_of_displaced_lens(lens, sensor_mm, lambda_nm, distance_mm);
  const double radius = length(sensor_mm);
  if (radius == 0.0) return {0.0, 0.0, 1.0};
  const double field = field_for(lens, lambda_nm, distance_mm, radius);
  const double sign = lens.focal_length_mm > 0.0 ? 1.0 : -1.0;
  const Vec2 azimuth = sensor_mm * (sign / radius);
  return {azimuth.x * std::sin(field), azimuth.y * std::sin(field), std::cos(field)};
}

Vec2 chief_ray_image_point(const LensState& lens, const LightSource& source, double lambda_nm) {
  const Vec3 d = source.direction;
  if (is_ideal_lens(lens)) return Vec2{d.x, d.y} * (lens.focal_length_mm / d.z);
  if (!has_stop(lens) || !std::isfinite(d.x + d.y + d.z)) return {kNan, kNan};
  if (is_anamorphic(lens)) return anamorphic_image_point(lens, source, lambda_nm);
  const Vec2 across{source.direction.x, source.direction.y};
  const double sine = length(across);
  if (!is_centred(lens)) {
    const LensState ideal = centred(lens);
    const double field = std::atan2(sine, source.direction.z);
    const double height_mm = sine > 0.0 ? chief_height_for(ideal, lambda_nm, source.distance_mm, field) : 0.0;
    const Vec2 start_mm = sine > 0.0 ? across * (height_mm / sine) : Vec2{};
    if (const auto chief = aim_chief(direct_path(lens, lambda_nm), source, start_mm)) return chief->image_mm;
    return chief_ray_image_point(ideal, source, lambda_nm);
  }
  if (sine == 0.0) return {};
  const double radius = radius_for(lens, lambda_nm, source.distance_mm, std::atan2(sine, source.direction.z));
  const double sign = lens.focal_length_mm > 0.0 ? 1.0 : -1.0;
  return across * (sign * radius / sine);
}

}  // namespace contrejour
