// SPDX-License-Identifier: Apache-2.0
#include "contrejour/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace contrejour {
namespace {

constexpr double kLargestRadius_rad = 0.25 * std::numbers::pi;
constexpr double kLargestTangent = 1.0 + 1e-9;  // tangent of 45 degrees
constexpr int kMaxShapeSide = 4096;

Vec3 cross_product(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

Result<void> check_shape(const LightShape& shape) {
  const Image& level = shape.level;
  if (level.width < 1 || level.height < 1 || level.width > kMaxShapeSide || level.height > kMaxShapeSide ||
      (level.channels != 1 && level.channels != 3) || level.pixels.size() != level.index(0, level.height))
    return invalid_argument("a light's shape must be a picture of one or three channels and 1 to 4096 pixels a side");
  double sum = 0.0;
  for (const float v : level.pixels) {
    if (!(v >= 0.0F) || !std::isfinite(v))
      return invalid_argument("the levels of a light's shape must be finite and 0 or more");
    sum += v;
  }
  if (!(sum > 0.0)) return invalid_argument("a light's shape is dark everywhere");
  for (const int corner : {0, 1, 2, 3}) {
    const Vec2 px{corner % 2 == 0 ? 0.0 : level.width, corner / 2 == 0 ? 0.0 : level.height};
    const Vec2 from = px - shape.centre_px;
    if (!(length(shape.right * from.x + shape.down * from.y) <= kLargestTangent))
      return invalid_argument("a light's shape must lie within 45 degrees of its direction");
  }
  return {};
}

// Unit vectors as the photographer sees them.
struct LightAxes {
  Vec3 towards_light, right, up;
};

LightAxes axes_about(Vec3 direction) {
  const Vec3 towards_light = -normalized(direction);
  const Vec3 right = cross_product(towards_light, {0.0, 1.0, 0.0});
  const Vec3 unit_right = length(right) > 1e-12 ? normalized(right) : Vec3{1.0, 0.0, 0.0};
  return {towards_light, unit_right, cross_product(unit_right, towards_light)};
}

bool is_visible_spectrum(const Spectrum& spectrum) {
  if (const auto* const table = std::get_if<TabulatedSpectrum>(&spectrum)) return is_visible(*table);
  const auto* const body = std::get_if<BlackBody>(&spectrum);
  return body == nullptr || (body->temperature_k >= 500.0 && body->temperature_k <= 100000.0);
}

}  // namespace

Result<void> check_light(const Light& light, ColourSpace space) {
  const Vec3 d = light.direction;
  if (!std::isfinite(d.x + d.y + d.z)) return invalid_argument("its direction is not a finite number");
  if (!(d.z > 0.0)) return invalid_argument("it is beside or behind the camera");
  if (!(light.distance_mm > 0.0)) return invalid_argument("its distance must be above 0");
  for (const double value : light.value) {
    if (!std::isfinite(value)) return invalid_argument("its value is not a finite number");
    if (std::abs(value) > kMaxLightValue)
      return invalid_argument(
          fmt::format("its value of {:.4g} is too large; {:.0e} is the limit", value, kMaxLightValue));
  }
  if (luminance(light.value, space) < 0.0) return invalid_argument("its value is negative");
  if (!is_visible_spectrum(light.spectrum)) return invalid_argument("nothing of its spectrum is visible");
  return check_extent(light);
}

// The direction is that in which light travels: a light on the right sends its light to the left.
Vec3 direction_from_angles(double azimuth_rad, double elevation_rad) {
  return {-std::sin(azimuth_rad) * std::cos(elevation_rad), -std::sin(elevation_rad),
          std::cos(azimuth_rad) * std::cos(elevation_rad)};
}

LightAngles angles_from_direction(Vec3 direction) {
  return {std::atan2(-direction.x, direction.z), std::atan2(-direction.y, std::hypot(direction.x, direction.z))};
}

Result<void> check_extent(const Light& light) {
  if (!(light.radius_rad >= 0.0 && light.radius_rad <= kLargestRadius_rad))
    return invalid_argument("a light's radius must be from 0 to 45 degrees");
  if (!light.shape) return {};
  if (light.radius_rad > 0.0) return invalid_argument("a light has a radius and a shape; give one of them");
  return check_shape(*light.shape);
}

LightShape coarser(const LightShape& shape, int by) {
  const Image& fine = shape.level;
  if (by <= 1 || fine.pixels.empty() || fine.pixels.size() != fine.index(0, fine.height)) return shape;
  by = std::min(by, std::max(fine.width, fine.height));
  LightShape out{Image((fine.width + by - 1) / by, (fine.height + by - 1) / by, fine.channels),
                 shape.centre_px * (1.0 / by), shape.right * by, shape.down * by};
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x)
      for (int c = 0; c < fine.channels; ++c) out.level.at(x / by, y / by, c) += fine.at(x, y, c);
  return out;
}

Vec3 offset_direction(Vec3 direction, Vec2 tangents) {
  const auto [towards_light, right, up] = axes_about(direction);
  return -normalized(towards_light + right * tangents.x + up * tangents.y);
}

Vec2 tangents_between(Vec3 direction, Vec3 other) {
  const auto [towards_light, right, up] = axes_about(direction);
  const Vec3 towards_other = -other;
  const double along = dot(towards_other, towards_light);
  return {dot(towards_other, right) / along, dot(towards_other, up) / along};
}

LightSource offset_source(const LightSource& source, Vec2 tangents) {
  return {offset_direction(source.direction, tangents), source.distance_mm};
}

}  // namespace contrejour
