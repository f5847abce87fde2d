// SPDX-License-Identifier: Apache-2.0
// The frame of a rotationally symmetric lens in which a light's meridian is the x-z plane: hullin2011 4.2, axial
// symmetry. Rays in this frame depend on one angle only, and y -> -y changes nothing but the iris.
#pragma once

#include "contrejour/expert/iris.h"
#include "contrejour/expert/light_source.h"
#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

struct Meridian {
  LightSource light;    // its direction: y = 0, x >= 0
  double rotation_rad = 0;  // rotation about the axis from this frame to the lens's
  [[nodiscard]] double angle_rad() const;  // of the light to the axis
};

// Every plane is a meridian of a light on the axis; it gets the one with no rotation.
[[nodiscard]] Meridian meridian_of(const LightSource& light);

// The iris in the meridian's frame.
[[nodiscard]] Iris rotated_back(Iris iris, const Meridian& meridian);

}  // namespace contrejour::inline internal
