// A distant light, as a renderer takes it.
#pragma once

#include "contrejour/colour.h"
#include "contrejour/vec.h"

namespace contrejour {

struct Light {
  Vec3 direction{0, 0, 1};  // unit, the way the light travels (z > 0)
  Rgb value{1, 1, 1};       // what the light's direct image sums to over its pixels, per channel
  Spectrum spectrum = IlluminantD65{};  // how each channel's value is spread over wavelength
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
