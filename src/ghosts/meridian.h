// A rotationally symmetric lens seen with a light's meridian as the x-z plane: hullin2011 4.2, axial symmetry.
// What rays do there depends on one angle only, and y -> -y changes nothing but the iris.
#pragma once

#include "contrejour/iris.h"
#include "contrejour/light_source.h"
#include "contrejour/vec.h"

namespace contrejour {

struct Meridian {
  LightSource light;    // its direction: y = 0, x >= 0
  double turn_rad = 0;  // about the axis, from here into place
  [[nodiscard]] double angle_rad() const;  // of the light to the axis
};

// A light on the axis has every meridian; it gets the one that turns nothing.
[[nodiscard]] Meridian meridian_of(const LightSource& light);

// The iris as it stands in the meridian's frame.
[[nodiscard]] Iris turned_back(Iris iris, const Meridian& meridian);

}  // namespace contrejour
