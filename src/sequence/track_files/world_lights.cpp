// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/track_files.h"
#include "sequence/track_files/value_keys.h"

namespace contrejour {
namespace {

constexpr double kMinDistance_mm = 1e-3, kMaxDistance_mm = 1e12;  // a light is distant long before that
constexpr double kMaxAngle_deg = 89.0;  // from the axis; beyond, a point does not shine onto the lens

// The vector in the frame that is rotated about an axis: the inverse of the rotation.
Vec3 in_rotated_frame(Vec3 v, char axis, double angle_deg) {
  const double c = std::cos(angle_deg * params::kDegree_rad), s = std::sin(angle_deg * params::kDegree_rad);
  switch (axis) {
    case 'X': return {v.x, c * v.y + s * v.z, c * v.z - s * v.y};
    case 'Y': return {c * v.x - s * v.z, v.y, c * v.z + s * v.x};
    default: return {c * v.x + s * v.y, c * v.y - s * v.x, v.z};
  }
}

// The point as the camera has it. The rotation that comes first in the order is the last to be undone.
Vec3 in_camera(const CameraPose& pose, Vec3 point, std::string_view rotation_order) {
  Vec3 v = point - pose.position;
  for (std::size_t k = rotation_order.size(); k-- > 0;) {
    const char axis = rotation_order[k];
    const double angle = axis == 'X' ? pose.rotation_deg.x : axis == 'Y' ? pose.rotation_deg.y : pose.rotation_deg.z;
    v = in_rotated_frame(v, axis, angle);
  }
  return v;
}

Result<Vec3> position_of(const WorldPoint& point, int frame) {
  if (!point.moves) return point.keys.front().position;
  const auto at = std::ranges::lower_bound(point.keys, frame, {}, [](const WorldPoint::At& key) { return key.frame; });
  if (at == point.keys.end() || at->frame != frame)
    return invalid_argument(
        fmt::format("\"{}\" has no position in frame {}, in which there is a camera; add it, or leave the "
                    "frame out of the camera",
                    shortened(point.name), frame));
  return at->position;
}

bool is_in_front(Vec3 v) { return std::atan2(std::hypot(v.x, v.y), -v.z) < kMaxAngle_deg * params::kDegree_rad; }

void add_change(KeyedValue& on, int frame, bool is_on) {
  const char* text = is_on ? "on" : "off";
  if (on.keys.empty() || on.keys.back().text != text) on.keys.push_back({frame, {}, text});
}

// One key where all are the same.
void simplify(KeyedValue& value) {
  const Key& first = value.keys.front();
  if (std::ranges::all_of(value.keys,
                          [&](const Key& key) { return key.numbers == first.numbers && key.text == first.text; }))
    value.keys = {{0, first.numbers, first.text}};
}

Result<AnimatedLight> light_of(const WorldPoint& point, std::span<const CameraPose> camera,
                               const WorldSettings& settings) {
  AnimatedLight light;
  light.name = point.name;
  light.by_direction = true;
  KeyedValue distance, on;
  for (const CameraPose& pose : camera) {
    const auto position = position_of(point, pose.frame);
    if (!position) return tl::unexpected(position.error());
    const Vec3 v = in_camera(pose, *position, settings.rotation_order);
    const bool is_on = is_in_front(v);
    add_change(on, pose.frame, is_on);
    if (!is_on) continue;
    const double right = std::atan2(v.x, -v.z), up = std::atan2(v.y, std::hypot(v.x, v.z));
    light.position.keys.push_back({pose.frame, {right / params::kDegree_rad, up / params::kDegree_rad}, {}});
    if (settings.unit_mm)
      distance.keys.push_back(
          {pose.frame, {std::clamp(length(v) * *settings.unit_mm, kMinDistance_mm, kMaxDistance_mm)}, {}});
  }
  if (light.position.keys.empty()) return light;
  simplify(light.position);
  if (settings.unit_mm) {
    simplify(distance);
    light.distance = distance;
  }
  if (on.keys.size() > 1) light.on = on;
  return light;
}

// The frame's pixels are square, so its sides are in the proportion of its numbers of pixels.
std::optional<KeyedValue> horizontal_fov(std::span<const CameraPose> camera, const WorldSettings& settings) {
  if (camera.empty() || !camera.front().vertical_fov_deg) return std::nullopt;
  const double aspect = static_cast<double>(settings.width) / settings.height;
  KeyedValue hfov;
  for (const CameraPose& pose : camera) {
    const double half = std::atan(aspect * std::tan(0.5 * *pose.vertical_fov_deg * params::kDegree_rad));
    hfov.keys.push_back({pose.frame, {std::clamp(2.0 * half / params::kDegree_rad, 0.01, 175.0)}, {}});
  }
  simplify(hfov);
  return hfov;
}

Result<void> check(const WorldSettings& settings) {
  std::string axes = settings.rotation_order;
  std::ranges::sort(axes);
  if (axes != "XYZ") return invalid_argument("the order of rotations is three axes, such as ZXY");
  if (settings.width < 1 || settings.height < 1) return invalid_argument("the camera needs the size of its frame");
  return {};
}

}  // namespace

Result<WorldLights> lights_of_world(std::span<const CameraPose> camera, std::span<const WorldPoint> points,
                                    const WorldSettings& settings) {
  if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
  const auto value = value_of_text(settings.value);
  if (!value) return tl::unexpected(value.error());
  WorldLights lights;
  if (auto hfov = horizontal_fov(camera, settings)) lights.animation.parameters.emplace_back("hfov", std::move(*hfov));
  for (const WorldPoint& point : points) {
    auto light = light_of(point, camera, settings);
    if (!light) return tl::unexpected(light.error());
    light->value = *value;
    if (light->position.keys.empty()) {
      lights.never_seen.push_back(point.name);
    } else {
      lights.animation.lights.push_back(std::move(*light));
    }
  }
  return lights;
}

}  // namespace contrejour
