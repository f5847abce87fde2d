// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/placement.h"

#include <cmath>

namespace contrejour::inline internal {
namespace {

// Rotations by some degrees and back leave rounding errors below this.
constexpr double kNoRotation = 1e-12;   // rad
constexpr double kNoShift_mm = 1e-9;

double tidy(double value, double smallest) { return std::abs(value) < smallest ? 0.0 : value; }

constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

// Applies the smallest rotation that takes this unit vector to +z (Rodrigues).
Vec3 rotated_back(Vec3 axis, Vec3 v) {
  const Vec3 k = cross(axis, {0, 0, 1});
  return v + cross(k, v) + cross(k, cross(k, v)) * (1.0 / (1.0 + axis.z));
}

}  // namespace

Placement rotation_about(int axis, double angle_rad) {
  const auto first = static_cast<std::size_t>((axis + 1) % 3), second = static_cast<std::size_t>((axis + 2) % 3);
  Placement out;
  const Placement from;
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  out.axes[first] = from.axes[first] * c + from.axes[second] * s;
  out.axes[second] = from.axes[second] * c - from.axes[first] * s;
  return out;
}

PoseAndRotation pose_of(const Placement& placement) {
  PoseAndRotation out;
  const Vec3 shift = placement.shift;
  out.pose.shift_mm = {tidy(shift.x, kNoShift_mm), tidy(shift.y, kNoShift_mm), tidy(shift.z, kNoShift_mm)};
  const Vec3 axis = normalized(placement.axes[2]);
  const bool upright = std::hypot(axis.x, axis.y) < kNoRotation && axis.z > 0.0;
  if (!upright) out.pose.axis = axis;
  if (axis.z <= -1.0 + kNoRotation) return out;  // reversed; validate() refuses it
  const Vec3 x = upright ? placement.axes[0] : rotated_back(axis, placement.axes[0]);
  out.rotation_rad = tidy(std::atan2(x.y, x.x), kNoRotation);
  return out;
}

}  // namespace contrejour::inline internal
