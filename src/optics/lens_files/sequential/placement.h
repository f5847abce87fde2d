// SPDX-License-Identifier: Apache-2.0
// Nested coordinate frames, by which design programs decentre and tilt.
#pragma once

#include <array>

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// A frame relative to another one: its origin and the directions of its x, y and z axes.
struct Placement {
  Vec3 shift{};
  std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

  [[nodiscard]] Vec3 rotated(Vec3 v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
  // The placement of a frame that is given relative to this one.
  [[nodiscard]] Placement then(const Placement& inner) const {
    return {shift + rotated(inner.shift), {rotated(inner.axes[0]), rotated(inner.axes[1]), rotated(inner.axes[2])}};
  }
  friend bool operator==(const Placement&, const Placement&) = default;
};

// A rotation about the frame's own axis 0 (x), 1 (y) or 2 (z), right-handed.
[[nodiscard]] Placement rotation_about(int axis, double angle_rad);

// The same in the form of our surfaces: the smallest rotation that points the axis there, after a rotation about the
// axis from x towards y. Rounding errors of moves that cancel are removed.
struct PoseAndRotation {
  SurfacePose pose;
  double rotation_rad = 0;
};
[[nodiscard]] PoseAndRotation pose_of(const Placement& placement);

}  // namespace contrejour::inline internal
