// SPDX-License-Identifier: Apache-2.0
#include "demo/street_shot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace contrejour::demo {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr Rgb kWhiteBeam{2400, 2300, 2050};

// 0 before `from`, 1 after `to`, smooth between.
double eased(double time, double from, double to) {
  const double t = std::clamp((time - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A hand's tremble: a sum of sines whose phases come from the seed; at most 1.
double shake(const ShotSettings& settings, int axis, double time) {
  double sum = 0.0;
  constexpr double kCycles[] = {5.3, 9.7, 17.1};
  for (int k = 0; k < 3; ++k) sum += std::sin(kTwoPi * (kCycles[k] * time + hash01(settings.seed, axis, k))) / 3.0;
  return sum;
}

CameraPose camera_at(const ShotSettings& settings, double time) {
  constexpr double kShake_rad = 0.0016;
  CameraPose pose;
  pose.position = {0.3 + 1.3 * time, 1.7 + 0.02 * std::sin(kTwoPi * 4.0 * time), 2.0 * time};
  pose.yaw_rad = -0.05 + 0.12 * eased(time, 0.05, 0.95) + kShake_rad * shake(settings, 0, time);
  pose.pitch_rad = 0.012 * std::sin(kTwoPi * 0.6 * time) + kShake_rad * shake(settings, 1, time);
  pose.roll_rad = 0.004 * shake(settings, 2, time);
  return pose;
}

// A turning car: its beams point at the camera once.
void add_turning_car(double time, Vec3 camera, std::vector<ShotLight>& lights) {
  constexpr double kBeamWidth_rad = 0.16, kScattered = 0.02;
  const double heading = -0.75 + 1.25 * eased(time, 0.1, 0.8);  // of the beams, from straight towards -z
  const Vec3 middle{-2.6 + 1.4 * time, 0.72, 46.0 - 4.0 * time};
  for (const double side : {-1.0, 1.0}) {
    const Vec3 at = middle + Vec3{std::cos(heading), 0.0, -std::sin(heading)} * (0.65 * side);
    const double to_camera = std::atan2(camera.x - at.x, at.z - camera.z);
    const double off = (heading - to_camera) / kBeamWidth_rad;
    const double strength = kScattered + std::exp(-0.5 * off * off);
    const Rgb radiance{kWhiteBeam[0] * strength, kWhiteBeam[1] * strength, kWhiteBeam[2] * strength};
    lights.push_back({side < 0.0 ? "headlight left" : "headlight right", {at, 0.085, radiance}});
  }
}

// Two lights that cross the street in opposite directions, one behind the other.
void add_crossing_lights(double time, std::vector<ShotLight>& lights) {
  lights.push_back({"bicycle", {{-2.2 + 5.5 * time, 2.45, 31.0}, 0.055, {620, 640, 700}}});
  lights.push_back({"taxi sign", {{3.4 - 3.6 * time, 2.60, 37.0}, 0.08, {700, 430, 40}}});
}

void add_leaving_car(double time, std::vector<ShotLight>& lights) {
  for (const double x : {1.2, 2.5})
    lights.push_back({x < 2.0 ? "tail left" : "tail right", {{x, 0.75, 24.0 + 14.0 * time}, 0.07, {160, 8, 3}}});
}

KeyedValue on_keys(const std::vector<bool>& is_on, int first) {
  KeyedValue on;
  for (std::size_t k = 0; k < is_on.size(); ++k)
    if (k == 0 || is_on[k] != is_on[k - 1])
      on.keys.push_back({first + static_cast<int>(k), {}, is_on[k] ? "on" : "off"});
  return on;
}

}  // namespace

// Three pass in front of the moon, and are thinner than it: its light dips and does not go out.
std::vector<Pole> shot_poles() {
  return {{-0.55, 9.0, 0.016}, {0.72, 10.0, 0.008}, {1.35, 9.0, 0.008}, {2.1, 14.0, 0.012}, {-2.6, 16.0, 0.03}};
}

ShotMoment shot_moment(const ShotSettings& settings, int frame) {
  const double time = frame / std::max(1.0, settings.frame_count - 1.0);
  ShotMoment moment;
  moment.camera = camera_at(settings, time);
  const std::vector<Lamp> lamps = street_lamps();
  for (std::size_t k = 0; k < lamps.size(); ++k) moment.lights.push_back({fmt::format("lamp {}", k + 1), lamps[k]});
  add_turning_car(time, moment.camera.position, moment.lights);
  add_crossing_lights(time, moment.lights);
  add_leaving_car(time, moment.lights);
  moment.lights.push_back({"traffic light", {{4.4, 3.1, 60.0}, 0.13, {4, 160, 90}}});
  moment.lights.push_back({"moon", moon(), false});
  return moment;
}

Animation true_animation(const ShotSettings& settings, const std::vector<std::vector<TrueLight>>& frames, int first) {
  Animation animation;
  animation.parameters = {{"detect", {{{0, {}, "off"}}, Interpolation::Linear}}};
  const std::vector<ShotLight> lights = shot_moment(settings, 0).lights;
  for (std::size_t light = 0; light < lights.size(); ++light) {
    AnimatedLight animated;
    animated.name = lights[light].name;
    animated.value.emplace();
    std::vector<bool> is_on;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const TrueLight& seen = frames[k][light];
      const int number = first + static_cast<int>(k);
      animated.position.keys.push_back(
          {number, {seen.position_px.x / settings.width, seen.position_px.y / settings.height}, {}});
      animated.value->keys.push_back({number, {seen.flux[0], seen.flux[1], seen.flux[2]}, {}});
      is_on.push_back(seen.is_in_picture && seen.flux[0] + seen.flux[1] + seen.flux[2] > 0.0);
    }
    if (std::find(is_on.begin(), is_on.end(), true) == is_on.end()) continue;
    animated.on = on_keys(is_on, first);
    animation.lights.push_back(std::move(animated));
  }
  return animation;
}

}  // namespace contrejour::demo
