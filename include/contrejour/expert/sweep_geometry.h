// SPDX-License-Identifier: Apache-2.0
// The geometry of a captured sweep, before any ghost is fitted: where the optical axis meets the picture, the focal
// length and distortion, the head's zero and the camera's roll, all from the positions of the light's own image.
// Units: pixels with (0, 0) at the picture's top left corner and y down; angles in radians. Errors: InvalidArgument.
// Thread-safety: pure functions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/expert/capture.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// The light's image at one station. The x axis of the picture points to where the light goes as the angle grows.
struct DirectImage {
  double angle_rad = 0;  // of the head
  Vec2 position_px;
};

// A point at angle a lands at centre + focal_length * tan(a - zero) * (1 + distortion * tan^2(a - zero)) along the
// roll's direction.
struct SweepGeometry {
  Vec2 centre_px;
  double focal_length_px = 0;
  double distortion = 0;
  double zero_rad = 0;
  double roll_rad = 0;  // of the light's path from the picture's rows, above 0 if it rises to the right
  double rms_px = 0;    // residual distance of the light's images
  Vec2 centre_error_px;  // standard errors of the centre along the light's path and across it

  [[nodiscard]] CONTREJOUR_API Vec2 position_of(double angle_rad) const;
};

// The position of the light's image in a short exposure: the centroid of it and the pixels at its edge, which is right
// to a tenth of a pixel where the image is at least three raw pixels wide. None where nothing is, or where the exposure
// is saturated there. In pixels of half the raw size, as merged pictures have.
[[nodiscard]] CONTREJOUR_API std::optional<Vec2> direct_image_position(const RawFrame& direct);

// The expected position of the optical axis before anything is measured: a camera's mount holds it near the picture's
// middle.
struct ExpectedCentre {
  Vec2 position_px;
  double error_px = 0;  // standard error, > 0
};
// A picture's middle, with an error of a hundredth of its width.
[[nodiscard]] CONTREJOUR_API ExpectedCentre expected_centre(int width, int height);

// Fits the geometry robustly: images farther off than the others (a reflection taken for the light) count little.
// A sweep to one side or over few degrees does not determine centre and zero well by the light's images alone: an
// expected centre keeps it near, and does nothing where the images determine it better. centre_error_px says how well
// both together do. If the angles run against the picture's x axis, the focal length is negative: the angles' sign is
// swapped. Errors: fewer than five images, or none of them far from the others; an expected error that is not above 0.
[[nodiscard]] CONTREJOUR_API Result<SweepGeometry> fit_geometry(std::span<const DirectImage> images,
                                                                const std::optional<ExpectedCentre>& expected = {});

}  // namespace contrejour
