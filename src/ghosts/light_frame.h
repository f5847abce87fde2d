// SPDX-License-Identifier: Apache-2.0
// A light's meridional frame and the rotation back from it: ghosts/meridian.h with sine and cosine precomputed. A lens
// without axial symmetry has no such frame; the lens's own is used.
#pragma once

#include <cmath>

#include "contrejour/expert/trace.h"
#include "ghosts/meridian.h"

namespace contrejour::inline internal {

struct LightFrame {
  LightSource source;  // its direction: y = 0, x >= 0 where symmetric
  double cos_rotation = 1, sin_rotation = 0;
  bool symmetric = true;  // y -> -y changes nothing

  explicit LightFrame(const LightSource& light, bool has_axial_symmetry = true)
      : LightFrame(has_axial_symmetry ? meridian_of(light) : Meridian{light, 0.0}) {
    symmetric = has_axial_symmetry;
  }
  [[nodiscard]] Vec2 to_lens_frame(Vec2 v) const {
    return {v.x * cos_rotation - v.y * sin_rotation, v.x * sin_rotation + v.y * cos_rotation};
  }

 private:
  explicit LightFrame(const Meridian& m)
      : source(m.light), cos_rotation(std::cos(m.rotation_rad)), sin_rotation(std::sin(m.rotation_rad)) {}
};

// A light's entrance window in both kinds of frames: for a convex front the window's bounds depend on the frame.
class LightWindows {
 public:
  LightWindows(const LensState& lens, const LightSource& light)
      : in_meridian_(entrance_window(lens, LightFrame(light).source)), in_lens_frame_(entrance_window(lens, light)) {}
  [[nodiscard]] const EntranceWindow& of(bool has_axial_symmetry) const {
    return has_axial_symmetry ? in_meridian_ : in_lens_frame_;
  }

 private:
  EntranceWindow in_meridian_, in_lens_frame_;
};

}  // namespace contrejour::inline internal
