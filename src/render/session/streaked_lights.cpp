// SPDX-License-Identifier: Apache-2.0
#include "render/session/streaked_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal {
namespace {

constexpr int kCells = 64;  // along a streak
constexpr double kLeastStreak = 1e-7;  // tangent: shorter ones are points
constexpr double kLongestStreak = 0.5;  // tangent: a light may reach 45 degrees from its direction

// How far the image moves in a unit of time, as tangents of the angle of a light that would
// move it as far through a lens that stays as it is.
Vec2 travelled(const LensState& lens, const Light& light, const Light& later, const FrameMotion& motion) {
  const double lambda_nm = lens.design_wavelength_nm;
  const auto direction_of = [&](const LensState& imaging, const Light& imaged) {
    const Vec2 at_mm = chief_ray_image_point(imaging, imaged.source(), lambda_nm);
    return direction_for_image_point(lens, at_mm, lambda_nm, light.distance_mm);
  };
  const Vec2 tangents = tangents_between(direction_of(lens, light), direction_of(motion.lens, later));
  if (!std::isfinite(tangents.x) || !std::isfinite(tangents.y)) return {};
  return tangents * (1.0 / motion.after);
}

// The line that a light moves along by this much in a unit of time, in square cells as bright as their times weigh.
LightShape streak_along(Vec2 by_time, const TimeWindow& window) {
  LightShape shape;
  shape.level = Image(kCells, 1, 1);
  const double cell = (window.fall_to - window.rise_from) / kCells;
  for (int x = 0; x < kCells; ++x)
    shape.level.at(x, 0) = static_cast<float>(weight_at(window, window.rise_from + (x + 0.5) * cell));
  shape.centre_px = {-window.rise_from / cell, 0.5};
  shape.right = by_time * cell;
  shape.down = {shape.right.y, -shape.right.x};
  return shape;
}

}  // namespace

std::vector<Light> streaked_lights(const LensState& lens, std::span<const Light> imaged, std::span<const Light> lights,
                                   const FrameMotion& motion) {
  std::vector<Light> streaks(imaged.begin(), imaged.end());
  for (Light& streak : streaks) {
    const auto own = std::ranges::find(lights, streak.source(), &Light::source);
    if (!streak.is_point() || own == lights.end()) continue;
    const Light& later = motion.lights[static_cast<std::size_t>(own - lights.begin())];
    const Vec2 by_time = travelled(lens, streak, later, motion);
    const double long_tangent = length(by_time) * (motion.window.fall_to - motion.window.rise_from);
    if (!(long_tangent > kLeastStreak)) continue;
    const double shorter = std::min(1.0, kLongestStreak / long_tangent);
    streak.shape = std::make_shared<const LightShape>(streak_along(by_time * shorter, motion.window));
  }
  return streaks;
}

}  // namespace contrejour::inline internal
