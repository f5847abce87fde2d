// SPDX-License-Identifier: Apache-2.0
// A light for a renderer: distant, or at a finite distance in front of the lens; a point, a disc, or a shape.
#pragma once

#include <limits>
#include <memory>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/light_source.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

// The radiance of a light as a picture over the angles about its direction, upright as the photographer sees it.
struct LightShape {
  Image level;     // one channel or three, of any scale: the relative part of the light's value from each pixel
  Vec2 centre_px;  // where in the picture the light's direction is; (0, 0) is its top left corner
  // A pixel to the right and a pixel down, as tangents of the angles from the direction, x to the right and y up.
  Vec2 right{1e-3, 0.0}, down{0.0, -1e-3};
};

struct Light {
  Vec3 direction{0, 0, 1};  // unit, direction of travel to the first vertex (z > 0)
  Rgb value{1, 1, 1};       // the sum of the light's direct image over its pixels, per channel
  Spectrum spectrum = IlluminantD65{};  // distribution of each channel's value over wavelength
  double distance_mm = std::numeric_limits<double>::infinity();  // to the first vertex, > 0
  // Its extent: a disc of this radius, evenly bright, or the shape; neither: a point. Whatever its size, its image sums
  // to `value` (docs/physics/area-lights.md).
  double radius_rad = 0.0;
  std::shared_ptr<const LightShape> shape = nullptr;

  [[nodiscard]] LightSource source() const { return {normalized(direction), distance_mm}; }
  [[nodiscard]] bool is_point() const { return radius_rad == 0.0 && !shape; }
};

inline constexpr double kSunRadius_rad = 0.00465;  // a diameter of 0.53 degrees

// The largest value of a light in any channel, also after all gains: 32-bit floats can represent it, and the sum of its
// squares over the largest picture. 1e16 is the value of the sun on 1e10 pixels.
inline constexpr double kMaxLightValue = 1e16;

// Errors: InvalidArgument for a direction that is not finite or leads away from the camera, a distance that is not
// above 0, values that are not finite, exceed kMaxLightValue or have a luminance below 0 in this space, a spectrum of
// which nothing is visible, a temperature that is not from 500 to 100000 K; those of check_extent.
[[nodiscard]] CONTREJOUR_API Result<void> check_light(const Light& light, ColourSpace space);

// Errors: InvalidArgument for a negative radius or one above 45 degrees; for a shape without light, that reaches
// farther from its direction than 45 degrees, of more than 4096 pixels a side, with levels that are negative or not
// finite; for both at once.
[[nodiscard]] CONTREJOUR_API Result<void> check_extent(const Light& light);

// Sums blocks of `by` x `by` pixels into one.
[[nodiscard]] CONTREJOUR_API LightShape coarser(const LightShape& shape, int by);

// The direction of a light with an offset from this one, to the right and up, in tangents of the angles.
[[nodiscard]] CONTREJOUR_API Vec3 offset_direction(Vec3 direction, Vec2 tangents);
// The inverse of offset_direction, for two directions less than 90 degrees apart.
[[nodiscard]] CONTREJOUR_API Vec2 tangents_between(Vec3 direction, Vec3 other);
// As offset_direction, for a light at any distance; its distance from the first vertex is unchanged.
[[nodiscard]] CONTREJOUR_API LightSource offset_source(const LightSource& source, Vec2 tangents);

// Azimuth to the right, elevation up, as the photographer sees them, radians; the travel direction.
// Errors (assert): |angle| must keep the light in front of the lens.
[[nodiscard]] CONTREJOUR_API Vec3 direction_from_angles(double azimuth_rad, double elevation_rad);

struct LightAngles {
  double azimuth_rad = 0;
  double elevation_rad = 0;
};
[[nodiscard]] CONTREJOUR_API LightAngles angles_from_direction(Vec3 direction);

}  // namespace contrejour
