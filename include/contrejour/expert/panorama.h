// SPDX-License-Identifier: Apache-2.0
// Lights and views of a panorama (latitude and longitude, radiance, scene-linear) for a camera that stands in its
// middle. The panorama's middle column is at azimuth 0, columns to its right lie to the right; its top is the zenith.
// Errors: InvalidArgument for a panorama that has not three channels or is not twice as wide as high. Thread-safety:
// pure functions; the same bits for any number of threads.
#pragma once

#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "contrejour/light.h"
#include "contrejour/result.h"

namespace contrejour {

// The direction of a camera: to the right, up, and turned anticlockwise about its axis.
struct CameraView {
  double azimuth_rad = 0, elevation_rad = 0, roll_rad = 0;
};

struct PanoramaLight {
  Vec3 towards;  // unit; x to the right of the panorama's middle, y up, z to its middle
  Rgb irradiance{};  // normal to it: radiance times solid angle
};

// The bright areas of a panorama (light_detection.h) and how much light comes from each.
[[nodiscard]] CONTREJOUR_API Result<std::vector<PanoramaLight>> lights_of_panorama(
    const Image& panorama, const DetectionSettings& settings = {});

// These lights for a camera without distortion, in the panorama's units: a light's value is the sum of its direct image
// over pixels, outside the frame that at the nearest point of the frame on the line to the centre. Lights more than 85
// degrees from the axis are left out.
[[nodiscard]] CONTREJOUR_API std::vector<Light> lights_in_view(std::span<const PanoramaLight> lights,
                                                               const CameraView& view, const Frame& frame,
                                                               double focal_length_mm);

// The picture that the camera sees, by bilinear interpolation.
[[nodiscard]] CONTREJOUR_API Result<Image> view_of_panorama(const Image& panorama, const CameraView& view,
                                                            const Frame& frame, double focal_length_mm,
                                                            const Context& context = {});

}  // namespace contrejour
