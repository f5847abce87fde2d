// Frames that stand in each other: how design programs decentre and tilt.
#pragma once

#include <array>

#include "contrejour/lens.h"

namespace contrejour {

// Where a frame stands in another one: its origin, and where its x, y and z axes point there.
struct Placement {
  Vec3 shift{};
  std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

  [[nodiscard]] Vec3 turned(Vec3 v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
  // Of a frame that stands so in this one.
  [[nodiscard]] Placement then(const Placement& inner) const {
    return {shift + turned(inner.shift), {turned(inner.axes[0]), turned(inner.axes[1]), turned(inner.axes[2])}};
  }
  friend bool operator==(const Placement&, const Placement&) = default;
};

// About the frame's own axis 0 (x), 1 (y) or 2 (z), right-handed.
[[nodiscard]] Placement turn_about(int axis, double angle_rad);

// The same as our surfaces have it: the smallest turn that points the axis there, and a turn about that axis, from x
// towards y, before it. What rounding leaves of moves that cancel is none.
struct PoseAndTurn {
  SurfacePose pose;
  double turn_rad = 0;
};
[[nodiscard]] PoseAndTurn pose_of(const Placement& placement);

}  // namespace contrejour
