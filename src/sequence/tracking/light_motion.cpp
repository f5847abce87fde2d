// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/light_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::inline internal {
namespace {

// Standard deviations of a light's likeness from frame to frame. Flux and size may change at once, when something
// comes in front of the light, so their costs are limited.
constexpr double kFluxDeviation = 0.5, kMaxFluxCost = 4.0;      // of the logarithm
constexpr double kRadiusDeviation = 0.4, kMaxRadiusCost = 2.0;  // of the logarithm
constexpr double kColourDeviation = 0.1, kMaxColourCost = 20.0;  // of the fractions of the channels

constexpr double kVelocityGain = 0.5;           // the part of a new velocity that is taken over
constexpr double kCoveredVelocityGain = 0.15;   // and of a light that is partly covered, whose centroid is displaced
constexpr double kShake = 0.7;                  // the part of what the camera adds to all lights that does not last
constexpr double kCovered = 0.7;                // of the light's flux
constexpr double kInnovationGain = 0.3;
constexpr double kMaxInnovation = 4.0;  // times the present one, so that one jump does not open the search

double limited_square(double deviation, double limit) { return std::min(limit, 0.5 * deviation * deviation); }

double colour_difference(const Rgb& a, const Rgb& b) {
  double squares = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double difference = a[c] / sum_of(a) - b[c] / sum_of(b);
    squares += difference * difference;
  }
  return std::sqrt(squares);
}

Vec2 half_size(const DetectedLight& light) {
  return {0.5 * (light.max_x - light.min_x + 1), 0.5 * (light.max_y - light.min_y + 1)};
}

double position_deviation_px(const LightMotion& motion) {
  const double of_light = 0.5 + 0.3 * motion.radius_px + 0.15 * length(motion.velocity_px);
  return (of_light + motion.innovation_px) * (1.0 + 0.5 * motion.missed);
}

void add_point(LightMotion& motion, int frame, const Rgb& flux) {
  if (sum_of(flux) > 0.0) motion.flux = flux;
  motion.position_frame = frame;
  motion.track.points.push_back({frame, motion.position_px, flux, motion.radius_px});
  ++motion.seen;
  motion.missed = 0;
}

}  // namespace

LightMotion new_motion(int frame, const DetectedLight& light, Vec2 velocity_px) {
  LightMotion motion;
  motion.position_px = light.centroid_px;
  motion.velocity_px = velocity_px;
  motion.radius_px = light.rms_radius_px;
  motion.half_size_px = half_size(light);
  add_point(motion, frame, light.flux);
  return motion;
}

// Student's distribution for the position: its tail is long, so one unexpected move costs less than a new light.
double cost_of(const LightMotion& motion, const DetectedLight& light, double tolerance_px) {
  const double deviation = position_deviation_px(motion) + tolerance_px;
  const double distance = length(light.centroid_px - motion.predicted_px) / deviation;
  const double flux = std::log(sum_of(light.flux) / sum_of(motion.flux)) / kFluxDeviation;
  const double radius = std::log(light.rms_radius_px / motion.radius_px) / kRadiusDeviation;
  const double colour = colour_difference(light.flux, motion.flux) / kColourDeviation;
  return 2.0 * std::log1p(0.25 * distance * distance) + limited_square(flux, kMaxFluxCost) +
         limited_square(radius, kMaxRadiusCost) + limited_square(colour, kMaxColourCost);
}

double search_radius_px(const LightMotion& motion, double search_px) {
  constexpr double kDeviations = 6.0;
  if (!motion.has_velocity()) return search_px * (1.0 + motion.missed);
  return std::min(kDeviations * position_deviation_px(motion), search_px * (1.0 + motion.missed));
}

void take(LightMotion& motion, int frame, const DetectedLight& light, bool is_whole) {
  const TrackPoint& last = motion.track.points.back();
  const Vec2 steady = light.centroid_px - kShake * motion.camera_px;
  const Vec2 velocity = (steady - last.position_px) * (1.0 / (frame - last.frame));
  const bool is_covered = sum_of(light.flux) < kCovered * sum_of(motion.flux);
  const double gain = motion.seen == 1 ? 1.0 : is_covered ? kCoveredVelocityGain : kVelocityGain;
  const double error = length(light.centroid_px - motion.predicted_px);
  if (motion.seen > 1)
    motion.innovation_px +=
        kInnovationGain * (std::min(error, kMaxInnovation * motion.innovation_px + 1.0) - motion.innovation_px);
  motion.velocity_px = motion.velocity_px + gain * (velocity - motion.velocity_px);
  motion.position_px = light.centroid_px;
  motion.radius_px = light.rms_radius_px;
  if (is_whole) motion.half_size_px = half_size(light);
  add_point(motion, frame, light.flux);
}

void take_part(LightMotion& motion, int frame, Vec2 position_px, const Rgb& flux) {
  const TrackPoint& last = motion.track.points.back();
  const Vec2 steady = position_px - kShake * motion.camera_px;
  const Vec2 velocity = (steady - last.position_px) * (1.0 / (frame - last.frame));
  motion.velocity_px = motion.velocity_px + kCoveredVelocityGain * (velocity - motion.velocity_px);
  motion.position_px = position_px;
  add_point(motion, frame, flux);
}

}  // namespace contrejour::inline internal
