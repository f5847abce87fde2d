// SPDX-License-Identifier: Apache-2.0
// Values -> the size of a frame's pixels on the sensor.
#include <algorithm>
#include <cmath>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/settings.h"

namespace contrejour::params {

double pixel_pitch_mm(const Values& values, const LensState& lens, Vec2 square_pixels) {
  const auto hfov_deg = values.real("hfov");
  if (!hfov_deg) return std::min(lens.sensor_width_mm / square_pixels.x, lens.sensor_height_mm / square_pixels.y);
  const double focal_length_mm =
      lens.has_axial_symmetry() ? lens.focal_length_mm : first_order(lens, lens.design_wavelength_nm).focal_length_x_mm;
  return 2.0 * focal_length_mm * std::tan(0.5 * *hfov_deg * kDegree_rad) / square_pixels.x;
}

Frame whole_frame(const Values& values, const LensState& lens, PixelSize size) {
  Frame frame = frame_on_sensor(lens, size.width, size.height);
  frame.pixel_pitch_mm =
      pixel_pitch_mm(values, lens, {static_cast<double>(size.width), static_cast<double>(size.height)});
  return frame;
}

}  // namespace contrejour::params
