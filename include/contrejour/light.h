// A light, as a renderer takes it: distant, or a point at a finite distance in front of the lens.
#pragma once

#include <limits>

#include "contrejour/colour.h"
#include "contrejour/light_source.h"
#include "contrejour/vec.h"

namespace contrejour {

struct Light {
  Vec3 direction{0, 0, 1};  // unit, the way the light travels to the first vertex (z > 0)
  Rgb value{1, 1, 1};       // what the light's direct image sums to over its pixels, per channel
  Spectrum spectrum = IlluminantD65{};  // how each channel's value is spread over wavelength
  double distance_mm = std::numeric_limits<double>::infinity();  // to the first vertex, > 0

  [[nodiscard]] LightSource source() const { return {normalized(direction), distance_mm}; }
};

// Azimuth to the right, elevation up, as the photographer sees them, radians; the travel direction.
// Errors (assert): |angle| must keep the light in front of the lens.
[[nodiscard]] Vec3 direction_from_angles(double azimuth_rad, double elevation_rad);

struct LightAngles {
  double azimuth_rad = 0;
  double elevation_rad = 0;
};
[[nodiscard]] LightAngles angles_from_direction(Vec3 direction);

}  // namespace contrejour
