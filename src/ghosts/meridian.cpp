// SPDX-License-Identifier: Apache-2.0
#include "ghosts/meridian.h"

#include <cmath>

namespace contrejour::inline internal {

double Meridian::angle_rad() const { return std::atan2(light.direction.x, light.direction.z); }

Meridian meridian_of(const LightSource& light) {
  const Vec3 direction = light.direction;
  const double across = std::hypot(direction.x, direction.y);
  return {{{across, 0.0, direction.z}, light.distance_mm}, across > 0.0 ? std::atan2(direction.y, direction.x) : 0.0};
}

Iris rotated_back(Iris iris, const Meridian& meridian) {
  iris.rotation_rad -= meridian.rotation_rad;
  return iris;
}

}  // namespace contrejour::inline internal
