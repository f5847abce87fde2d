// SPDX-License-Identifier: Apache-2.0
#include "demo/street_camera.h"

#include <cmath>

namespace contrejour::demo {
namespace {

constexpr double kShift = 0.16;  // of the optical axis below the middle of the picture, as a fraction of its height

Vec3 cross_product(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

}  // namespace

StreetCamera::StreetCamera(const CameraPose& pose, int width, int height, double hfov_rad)
    : position_(pose.position), axis_px_{0.5 * width, (0.5 + kShift) * height},
      scale_(2.0 * std::tan(0.5 * hfov_rad) / width) {
  const double cosine = std::cos(pose.pitch_rad);
  forward_ = {std::sin(pose.yaw_rad) * cosine, std::sin(pose.pitch_rad), std::cos(pose.yaw_rad) * cosine};
  const Vec3 level = normalized(cross_product({0.0, 1.0, 0.0}, forward_));
  const Vec3 upright = cross_product(forward_, level);
  right_ = level * std::cos(pose.roll_rad) - upright * std::sin(pose.roll_rad);
  up_ = upright * std::cos(pose.roll_rad) + level * std::sin(pose.roll_rad);
}

Vec3 StreetCamera::direction_of(Vec2 pixel) const {
  return normalized(right_ * ((pixel.x - axis_px_.x) * scale_) + up_ * ((axis_px_.y - pixel.y) * scale_) + forward_);
}

std::optional<Vec2> StreetCamera::pixel_of(Vec3 point) const {
  const Vec3 ray = point - position_;
  const double depth = dot(ray, forward_);
  if (depth <= 0.0) return std::nullopt;
  return Vec2{axis_px_.x + dot(ray, right_) / (depth * scale_), axis_px_.y - dot(ray, up_) / (depth * scale_)};
}

double StreetCamera::pixels_per_solid_angle(Vec3 direction) const {
  const double cosine = dot(direction, forward_);
  return 1.0 / (scale_ * scale_ * cosine * cosine * cosine);
}

}  // namespace contrejour::demo
