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
constexpr double kMoonRadius_rad = 0.0046, kMoonDistance_m = 1e6;
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;
constexpr double kPoleHeight_m = 9.0;
constexpr Rgb kPole{0.004, 0.004, 0.005};
constexpr Rgb kMoon{9000, 8500, 7500};
constexpr double kShade =
    2.6;  // the lamps' shades direct this factor more light onto the street than towards the camera
constexpr Rgb kSodium{900, 470, 130};
constexpr Rgb kWhite{650, 670, 690};

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
  return along > 0.0 && offset2 < r2 ? along - std::sqrt(r2 - offset2) : kFar;
}

// The distance to the nearest pole, infinite if the ray misses all.
double nearest_pole(const std::vector<Pole>& poles, Vec3 origin, Vec3 direction) {
  double nearest = kFar;
  const double level2 = direction.x * direction.x + direction.z * direction.z;
  for (const Pole& pole : poles) {
    const Vec2 to_axis{pole.x - origin.x, pole.z - origin.z};
    const double along = (to_axis.x * direction.x + to_axis.y * direction.z) / level2;
    const double past = (to_axis.x * direction.z - to_axis.y * direction.x) / std::sqrt(level2);
    const double half_chord2 = (pole.radius * pole.radius - past * past) / level2;
    if (along <= 0.0 || half_chord2 <= 0.0) continue;
    const double t = along - std::sqrt(half_chord2);
    const double height = origin.y + t * direction.y;
    if (height > 0.0 && height < kPoleHeight_m) nearest = std::min(nearest, t);
  }
  return nearest;
}

double fresnel(double cosine) { return 0.02 + 0.98 * std::pow(1.0 - cosine, 5.0); }
double puddle(Vec3 point) { return 0.25 + 0.35 * (0.5 + 0.5 * std::sin(0.7 * point.x + 0.31 * point.z)); }

Rgb hazy(Rgb colour, double distance) {
  if (!std::isfinite(distance)) return colour;
  const double clear = haze_transmittance(distance);
  return colour * Rgb{clear, clear, clear} + Rgb{0.030, 0.026, 0.024} * (1.0 - clear);
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

double haze_transmittance(double distance) { return std::exp(-distance / kFog_m); }

std::vector<Lamp> street_lamps() {
  std::vector<Lamp> lamps;
  for (int k = 0; k < 9; ++k) {
    const double z = 24.0 + 21.0 * k;
    lamps.push_back({{-4.7, 5.6, z}, 0.17, kSodium});
    lamps.push_back({{4.7, 5.6, z + 10.5}, 0.17, k % 3 == 1 ? kWhite : kSodium});
  }
  return lamps;
}

Lamp moon() { return {moon_direction() * kMoonDistance_m, kMoonDistance_m * std::tan(kMoonRadius_rad), kMoon}; }

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

Rgb StreetScene::sky(Vec3 direction, bool with_moon) {
  const double from_moon = std::acos(std::clamp(dot(direction, moon_direction()), -1.0, 1.0));
  if (with_moon && from_moon < kMoonRadius_rad) return kMoon;
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

// A wet film: Fresnel reflection of water (Schlick), with slopes that are longer across the view than along it.
Rgb StreetScene::mirrored(Vec3 point, Vec3 direction) const {
  const double slope = 0.035;
  const Vec3 normal = normalized({slope * ripple(point.x, point.z), 1.0, slope * ripple(point.z + 5.0, point.x)});
  const double cosine = std::max(0.0, -dot(direction, normal));
  Vec3 reflected = direction + normal * (2.0 * cosine);
  reflected.y = std::max(reflected.y, 1e-4);
  return radiance(point + Vec3{0.0, 1e-3, 0.0}, normalized(reflected), Road::Matt) * (fresnel(cosine) * puddle(point));
}

// A Gaussian lobe about the mirrored direction, wider along the view: each lamp becomes a streak towards the camera.
Rgb StreetScene::soft_reflections(Vec3 point, Vec3 direction) const {
  constexpr double kAcross_rad = 0.022, kAlong_rad = 0.11;
  constexpr double kRoughness = 0.25;  // what the lobe holds of a mirror's reflection
  const Vec3 reflected{direction.x, -direction.y, direction.z};
  Rgb sum{};
  for (const Lamp& lamp : lamps_) {
    const Vec3 to_lamp = lamp.centre - point;
    const double d2 = dot(to_lamp, to_lamp);
    const Vec3 off = to_lamp * (1.0 / std::sqrt(d2)) - reflected;
    const double across = off.x / kAcross_rad, along = off.y / kAlong_rad;
    if (across * across > 25.0 || to_lamp.z < 0.0) continue;
    const double solid_angle = kPi * lamp.radius * lamp.radius / d2;
    const double lobe = std::exp(-0.5 * (across * across + along * along)) / (2.0 * kPi * kAcross_rad * kAlong_rad);
    sum = sum + lamp.radiance * (solid_angle * lobe);
  }
  return sum * (kRoughness * fresnel(std::max(0.0, -direction.y)) * puddle(point));
}

Rgb StreetScene::road(Vec3 point, Vec3 direction, Road kind) const {
  const bool pavement = std::abs(point.x) > 4.2;
  const bool line = std::abs(point.x) < 0.07 && std::fmod(point.z, 6.0) < 3.0;
  const double albedo = pavement ? 0.14 : line ? 0.35 : 0.06;
  const Rgb colour = (lamp_light(point, {0.0, 1.0, 0.0}) + Rgb{0.012, 0.014, 0.022}) * albedo;
  if (kind == Road::Matt || pavement) return colour;
  return colour + (kind == Road::Wet ? mirrored(point, direction) : soft_reflections(point, direction));
}

StreetScene::Surface StreetScene::nearest_surface(Vec3 origin, Vec3 direction, Road kind) const {
  const double side = direction.x > 0.0 ? 1.0 : -1.0;
  const double to_wall = (side * kWall_m - origin.x) / direction.x;
  const double to_road = direction.y < 0.0 ? -origin.y / direction.y : kFar;
  const double to_pole = nearest_pole(poles_, origin, direction);
  const Vec3 on_wall = origin + direction * to_wall;
  if (to_pole < std::min(to_road, to_wall)) return {kPole, to_pole};
  if (to_road < to_wall) return {road(origin + direction * to_road, direction, kind), to_road};
  if (to_wall > 0.0 && on_wall.y > 0.0 && on_wall.y < house_height(on_wall.z, side))
    return {wall(on_wall, side), to_wall};
  return {sky(direction, kind != Road::Damp), kFar};
}

Rgb StreetScene::radiance(Vec3 origin, Vec3 direction) const { return radiance(origin, direction, Road::Wet); }

Rgb StreetScene::radiance(Vec3 origin, Vec3 direction, Road kind) const {
  Surface seen = nearest_surface(origin, direction, kind);
  for (const Lamp& lamp : lamps_) {
    const double t = distance_to(lamp, origin, direction);
    if (t < seen.distance) seen = {lamp.radiance, t};
  }
  return hazy(seen.colour, seen.distance);
}

Rgb StreetScene::background(Vec3 origin, Vec3 direction) const {
  const Surface seen = nearest_surface(origin, direction, Road::Damp);
  return hazy(seen.colour, seen.distance);
}

bool StreetScene::is_visible(Vec3 from, Vec3 point) const {
  const double distance = length(point - from);
  return nearest_pole(poles_, from, (point - from) * (1.0 / distance)) > distance;
}

}  // namespace contrejour::demo
