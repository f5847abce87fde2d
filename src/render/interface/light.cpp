#include "contrejour/light.h"

#include <cmath>

namespace contrejour {

// A light to the right sends its light to the left: direction is away from it.
Vec3 direction_from_angles(double azimuth_rad, double elevation_rad) {
  return {-std::sin(azimuth_rad) * std::cos(elevation_rad), -std::sin(elevation_rad),
          std::cos(azimuth_rad) * std::cos(elevation_rad)};
}

LightAngles angles_from_direction(Vec3 direction) {
  return {std::atan2(-direction.x, direction.z), std::atan2(-direction.y, std::hypot(direction.x, direction.z))};
}

}  // namespace contrejour
