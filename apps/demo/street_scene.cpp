// SPDX-License-Identifier: Apache-2.0
#include "demo/street_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::demo {
namespace {

constexpr double kWall_m = 6.5;        // distance of the houses from the middle of the street
constexpr double kHouse_m = 11.0;      // width of a house along the street
constexpr double kWindowStep_m = 2.6, kFloor_m = 3.2;
constexpr double kFog_m = 220.0;       // distance over which haze reduces light to 1/e
constexpr double kMoonRadius_rad = 0.0046;
constexpr Rgb kMoon{9000, 8500, 7500};
constexpr double kShade =
    2.6;  // the lamps' shades direct this factor more light onto the street than towards the camera
constexpr Rgb kSodium{900, 470, 130};
constexpr Rgb kWhite{650, 670, 690};
constexpr Rgb kHeadlight{2400, 2300, 2050};

Rgb operator*(Rgb a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Rgb operator+(Rgb a, Rgb b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Rgb operator*(Rgb a, Rgb b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

Vec3 moon_direction() { return normalized({0.040, 0.128, 1.0}); }

double house_height(double z, double side) {
  return 9.0 + 8.0 * hash01(static_cast<std::int64_t>(std::floor(z / kHouse_m)), side > 0 ? 1 : 0, 7);
}

// The distance to a sphere, infinite if the ray misses it.
double distance_to(const Lamp& lamp, Vec3 origin, Vec3 direction) {
  const Vec3 to_lamp = lamp.centre - origin;
  const double along = dot(to_lamp, direction);
  const double offset2 = dot(to_lamp, to_lamp) - along * along;
  const double r2 = lamp.radius * lamp.radius;
  return along > 0.0 && offset2 < r2 ? along - std::sqrt(r2 - offset2) : std::numeric_limits<double>::infinity();
}

// Smooth noise of the slope of the asphalt, with wavelengths of some centimetres to decimetres.
double ripple(double x, double z) {
  return 0.5 * std::sin(7.1 * x + 3.3 * std::sin(2.3 * z)) + 0.3 * std::sin(19.0 * x - 11.0 * z) +
         0.2 * std::sin(41.0 * x + 29.0 * z);
}

}  // namespace

double hash01(std::int64_t a, std::int64_t b, std::int64_t c) {
  // SplitMix64 of the three numbers, mixed in order.
  std::uint64_t h = 0x9E3779B97F4A7C15ULL;
  for (const std::int64_t value : {a, b, c}) {
    h = (h ^ static_cast<std::uint64_t>(value)) * 0xBF58476D1CE4E5B9ULL;
    h = (h ^ (h >> 27U)) * 0x94D049BB133111EBULL;
    h ^= h >> 31U;
  }
  return static_cast<double>(h >> 11U) * 0x1.0p-53;
}

StreetScene::StreetScene() {
  for (int k = 0; k < 9; ++k) {
    const double z = 24.0 + 21.0 * k;
    lamps_.push_back({{-4.7, 5.6, z}, 0.17, kSodium});
    lamps_.push_back({{4.7, 5.6, z + 10.5}, 0.17, k % 3 == 1 ? kWhite : kSodium});
  }
  for (const double x : {-2.6, -1.3}) lamps_.push_back({{x, 0.68, 47.0}, 0.085, kHeadlight});
  for (const double x : {1.2, 2.5}) lamps_.push_back({{x, 0.75, 33.0}, 0.07, {60, 3, 1}});
  lamps_.push_back({{4.4, 3.1, 60.0}, 0.13, {4, 80, 45}});  // traffic light
}

Rgb StreetScene::lamp_light(Vec3 point, Vec3 normal) const {
  Rgb sum{};
  for (const Lamp& lamp : lamps_) {
    const Vec3 to_lamp = lamp.centre - point;
    const double d2 = dot(to_lamp, to_lamp) + 0.3;  // avoids the singularity of point lights
    const double cosine = dot(to_lamp, normal) / std::sqrt(d2);
    if (cosine > 0.0) sum = sum + lamp.radiance * (kShade * cosine * lamp.radius * lamp.radius / d2);
  }
  return sum;
}

Rgb StreetScene::sky(Vec3 direction) const {
  const Vec3 moon = moon_direction();
  const double from_moon = std::acos(std::clamp(dot(direction, moon), -1.0, 1.0));
  if (from_moon < kMoonRadius_rad) return kMoon;
  const double up = std::clamp(direction.y, 0.0, 1.0);
  const Rgb glow = Rgb{0.30, 0.27, 0.22} * (0.012 / (0.012 + from_moon));  // haze around the moon
  return Rgb{0.022, 0.026, 0.042} * std::exp(-3.0 * up) + Rgb{0.03, 0.018, 0.01} * std::exp(-14.0 * up) + glow;
}

Rgb StreetScene::wall(Vec3 point, double side) const {
  const auto column = static_cast<std::int64_t>(std::floor(point.z / kWindowStep_m));
  const auto floor_number = static_cast<std::int64_t>(std::floor(point.y / kFloor_m));
  const double across = point.z / kWindowStep_m - static_cast<double>(column);
  const double upward = point.y / kFloor_m - static_cast<double>(floor_number);
  const bool in_window = across > 0.28 && across < 0.72 && upward > 0.32 && upward < 0.80;
  const std::int64_t side_index = side > 0 ? 1 : 0;
  if (in_window && hash01(column, floor_number, 11 + side_index) < 0.22) {
    const double level = 0.5 + 5.0 * std::pow(hash01(column, floor_number, 21 + side_index), 2.0);
    const double warmth = hash01(column, floor_number, 31 + side_index);
    const bool is_bar = std::abs(across - 0.5) < 0.02 || std::abs(upward - 0.6) < 0.012;
    return Rgb{1.0, 0.55 + 0.35 * warmth, 0.20 + 0.6 * warmth} * (is_bar ? 0.15 * level : level);
  }
  const double stone = 0.05 + 0.05 * hash01(static_cast<std::int64_t>(std::floor(point.z / kHouse_m)), side_index, 3);
  const double grain = 0.92 + 0.08 * std::sin(1.7 * point.y + 2.0 * std::sin(0.9 * point.z));
  const Rgb albedo =
      in_window ? Rgb{0.02, 0.02, 0.025} : Rgb{stone * grain, 0.92 * stone * grain, 0.80 * stone * grain};
  return albedo * (lamp_light(point, {-side, 0.0, 0.0}) + Rgb{0.012, 0.014, 0.022});
}

Rgb StreetScene::road(Vec3 point, Vec3 direction, bool may_reflect) const {
  const bool pavement = std::abs(point.x) > 4.2;
  const bool line = std::abs(point.x) < 0.07 && std::fmod(point.z, 6.0) < 3.0;
  const double albedo = pavement ? 0.14 : line ? 0.35 : 0.06;
  Rgb colour = (lamp_light(point, {0.0, 1.0, 0.0}) + Rgb{0.012, 0.014, 0.022}) * albedo;
  if (!may_reflect || pavement) return colour;
  // A wet film: Fresnel reflection of water (Schlick), with slopes that are longer across the view than along it.
  const double slope = 0.035;
  const Vec3 normal = normalized({slope * ripple(point.x, point.z), 1.0, slope * ripple(point.z + 5.0, point.x)});
  const double cosine = std::max(0.0, -dot(direction, normal));
  Vec3 mirrored = direction + normal * (2.0 * cosine);
  mirrored.y = std::max(mirrored.y, 1e-4);
  const double fresnel = 0.02 + 0.98 * std::pow(1.0 - cosine, 5.0);
  const double puddle = 0.25 + 0.35 * (0.5 + 0.5 * std::sin(0.7 * point.x + 0.31 * point.z));
  return colour + radiance(point + Vec3{0.0, 1e-3, 0.0}, normalized(mirrored), false) * (fresnel * puddle);
}

Rgb StreetScene::radiance(Vec3 origin, Vec3 direction, bool may_reflect) const {
  double nearest = std::numeric_limits<double>::infinity();
  const Lamp* lamp = nullptr;
  for (const Lamp& candidate : lamps_) {
    const double t = distance_to(candidate, origin, direction);
    if (t < nearest) {
      nearest = t;
      lamp = &candidate;
    }
  }
  const double side = direction.x > 0.0 ? 1.0 : -1.0;
  const double to_wall = (side * kWall_m - origin.x) / direction.x;
  const double to_road = -origin.y / direction.y;
  const Vec3 on_wall = origin + direction * to_wall;
  Rgb colour = sky(direction);
  double distance = std::numeric_limits<double>::infinity();
  if (direction.y < 0.0 && to_road < std::min(nearest, to_wall)) {
    distance = to_road;
    colour = road(origin + direction * to_road, direction, may_reflect);
  } else if (to_wall > 0.0 && to_wall < nearest && on_wall.y > 0.0 && on_wall.y < house_height(on_wall.z, side)) {
    distance = to_wall;
    colour = wall(on_wall, side);
  } else if (lamp != nullptr) {
    distance = nearest;
    colour = lamp->radiance;
  }
  if (!std::isfinite(distance)) return colour;
  const double clear = std::exp(-distance / kFog_m);
  return colour * Rgb{clear, clear, clear} + Rgb{0.030, 0.026, 0.024} * (1.0 - clear);
}

}  // namespace contrejour::demo
