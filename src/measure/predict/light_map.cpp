// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/tasks.h"
#include "base/units.h"
#include "contrejour/expert/flare_prediction.h"
#include "measure/playback/measured_range.h"

namespace contrejour {
namespace {

constexpr double kSourceRadius_rad = 0.00436;  // 0.25 degrees, a usual test source
constexpr double kLargestAngle_rad = 80.0 * std::numbers::pi / 180.0;
constexpr int kMaxAngles = 2000, kMaxDirections = 361;

// Whether the flare of a light up and to the right is that of one down or to the left, mirrored.
bool has_quarters(const FlareSource& source) {
  const auto* lens = std::get_if<LensState>(&source);
  if (lens == nullptr) return true;
  return lens->has_axial_symmetry() && lens->iris.blades < 3 && !lens->iris.field && !lens->dirt.any();
}

Vec3 direction_at(double angle_rad, double direction_rad) {
  const double sideways = std::sin(angle_rad);
  return {-sideways * std::cos(direction_rad), -sideways * std::sin(direction_rad), std::cos(angle_rad)};
}

Result<void> check_map(const LightMapSettings& settings, double to_rad) {
  const bool counts = settings.angles >= 2 && settings.angles <= kMaxAngles && settings.directions >= 2 &&
                      settings.directions <= kMaxDirections;
  if (counts && to_rad > 0.0 && to_rad <= kLargestAngle_rad) return {};
  return invalid_argument(
      fmt::format("a map needs 2 to {} angles up to 80 degrees, in 2 to {} directions; not {} up to {:g}, in {}",
                  kMaxAngles, kMaxDirections, settings.angles, deg_from_rad(to_rad), settings.directions));
}

std::vector<LightMapPoint> points_of(const LightMap& map) {
  std::vector<LightMapPoint> points{LightMapPoint{}};
  const double quarter = 0.5 * std::numbers::pi;
  for (int d = 0; d < map.directions; ++d) {
    const double turn = map.is_quarter ? quarter * d / (map.directions - 1) : 4.0 * quarter * d / map.directions;
    for (int a = 1; a < map.angles; ++a) points.push_back({map.to_rad * a / (map.angles - 1), turn, {}});
  }
  return points;
}

// The context of one of `count` renderings in order, whose progress is a part of the whole.
Context part_of(const Context& whole, std::size_t k, std::size_t count) {
  Context part = whole;
  if (whole.progress) {
    part.progress = [&whole, k, count](double done) {
      whole.progress((static_cast<double>(k) + done) / static_cast<double>(count));
    };
  }
  return part;
}

Result<LightFigures> figures_at(const FlareSource& source, const LightMapSettings& settings, Light light, double level,
                                const Context& context) {
  light.radius_rad = 0.0;  // a disc of half a degree blurs ghosts too little to change their figures
  const auto flare = render(settings.method, source, std::span(&light, 1), settings.frame, context);
  if (!flare) return tl::unexpected(flare.error());
  const auto figures = figures_of(flare->image, settings.figures);
  if (!figures) return tl::unexpected(figures.error());
  const auto glare = glare_of(flare->image, level, settings.figures.space);
  if (!glare) return tl::unexpected(glare.error());
  return LightFigures{*figures, *glare};
}

}  // namespace

double largest_light_angle(const FlareSource& source, const Frame& frame) {
  if (const auto* flare = std::get_if<MeasuredFlare>(&source)) {
    return std::min(std::atan((1.0 + kBeyondRange) * flare->s_max), kLargestAngle_rad);
  }
  const double half_diagonal_mm = 0.5 * frame.pixel_pitch_mm * std::hypot(frame.full_width, frame.full_height);
  return std::min(2.0 * std::atan(half_diagonal_mm / std::abs(std::get<LensState>(source).focal_length_mm)),
                  kLargestAngle_rad);
}

Result<LightMap> map_lights(const FlareSource& source, const LightMapSettings& settings, const Context& context) {
  LightMap map;
  map.to_rad = settings.to_rad > 0.0 ? settings.to_rad : largest_light_angle(source, settings.frame.frame);
  if (auto ok = check_map(settings, map.to_rad); !ok) return tl::unexpected(ok.error());
  map.is_quarter = has_quarters(source);
  map.angles = settings.angles;
  map.directions = map.is_quarter ? settings.directions : 4 * (settings.directions - 1);
  map.points = points_of(map);
  const double radius_rad = settings.light.radius_rad > 0.0 ? settings.light.radius_rad : kSourceRadius_rad;
  const double value = luminance(settings.light.value, settings.figures.space);
  const auto level = direct_level(value, radius_rad, settings.frame.frame, geometry_of(source).focal_length_mm);
  if (!level) return tl::unexpected(level.error());
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    if (context.cancelled()) return interrupted();
    LightMapPoint& point = map.points[k];
    Light light = settings.light;
    light.direction = direction_at(point.angle_rad, point.direction_rad);
    const auto figures = figures_at(source, settings, light, *level, part_of(context, k, map.points.size()));
    if (!figures) return tl::unexpected(figures.error());
    point.figures = *figures;
  }
  return map;
}

std::vector<double> values_of(const LightMap& map, Estimator estimator) {
  std::vector<double> values;
  for (const LightMapPoint& point : map.points) values.push_back(value_of(point.figures, estimator));
  return values;
}

}  // namespace contrejour
