// SPDX-License-Identifier: Apache-2.0
#include "compositing/detected_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"

namespace contrejour {
namespace {

using params::Values;

constexpr double kMaxPointRadius_px = 1.0;  // root mean square radius up to which a light is a point
constexpr int kMaxShapeSide_px = 512;

Light light_of(const DetectedLight& area, const Spectrum& spectrum, const PixelGrid& grid, const LensState& lens,
               const Values& values) {
  const double gain = params::gain(values);
  Light light;
  light.distance_mm = *params::parse_distance_mm(*values.text("light-distance"));
  light.direction = direction_for_image_point(lens, grid.sensor_from_pixel(area.centroid_px), lens.design_wavelength_nm,
                                              light.distance_mm);
  light.value = {area.flux[0] * gain, area.flux[1] * gain, area.flux[2] * gain};
  light.spectrum = spectrum;
  return light;
}

// The angles that a pixel to the right and a pixel down correspond to around a light's direction, as tangents. They
// follow from the displacement of its image by small changes of the direction. nullopt if no light reaches the sensor.
std::optional<LightShape> angles_of_pixels(const LightSource& source, const PixelGrid& grid, const LensState& lens) {
  constexpr double kStep = 1e-3;
  const auto image_px = [&](Vec2 tangents) {
    return grid.pixel_from_sensor(
        chief_ray_image_point(lens, offset_source(source, tangents), lens.design_wavelength_nm));
  };
  const Vec2 x = (image_px({kStep, 0.0}) - image_px({-kStep, 0.0})) * (0.5 / kStep);
  const Vec2 y = (image_px({0.0, kStep}) - image_px({0.0, -kStep})) * (0.5 / kStep);
  const double determinant = cross(x, y);
  if (!std::isnormal(determinant)) return std::nullopt;
  LightShape shape;
  shape.right = {y.y / determinant, -x.y / determinant};
  shape.down = {-y.x / determinant, x.x / determinant};
  return shape;
}

// Gives a light the extent of its pixels, if it is larger than a point and a renderer accepts that shape.
void give_shape(Light& light, const DetectedLight& area, const Detection& found, const Image& rgb,
                const PixelGrid& grid, const LensState& lens) {
  if (!(area.rms_radius_px > kMaxPointRadius_px)) return;
  auto shape = angles_of_pixels(light.source(), grid, lens);
  if (!shape) return;
  shape->level = picture_of_areas(rgb, found, area);
  shape->centre_px = area.centroid_px - Vec2{static_cast<double>(area.min_x), static_cast<double>(area.min_y)};
  const int side = std::max(shape->level.width, shape->level.height);
  Light shaped = light;
  shaped.shape = std::make_shared<const LightShape>(
      side > kMaxShapeSide_px ? coarser(*shape, side / kMaxShapeSide_px + 1) : std::move(*shape));
  if (check_extent(shaped)) light = shaped;
}

}  // namespace

std::vector<Light> lights_of(const Detection& found, const Spectrum& spectrum, const Image& rgb, const PixelGrid& grid,
                             const LensState& lens, const Values& values) {
  std::vector<Light> lights;
  for (const DetectedLight& area : found.lights) {
    lights.push_back(light_of(area, spectrum, grid, lens, values));
    if (values.is_on("light-shape")) give_shape(lights.back(), area, found, rgb, grid, lens);
  }
  return lights;
}

}  // namespace contrejour
