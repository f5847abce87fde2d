// SPDX-License-Identifier: Apache-2.0
// The one mapping between sensor millimetres and image pixels.
// A camera turns its picture upright: sensor +x (right, as the photographer sees it) is image left, sensor +y
// (up) is image down. Pixel (0, 0) is the top-left one and covers [0,1) x [0,1). Pixels are square.
#pragma once

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

// What is rendered: a window of width x height pixels whose top-left corner lies at (origin_x, origin_y) of
// the full frame of full_width x full_height pixels centred on the axis.
struct Frame {
  int width = 0, height = 0;
  int origin_x = 0, origin_y = 0;
  int full_width = 0, full_height = 0;
  double pixel_pitch_mm = 0.01;
  Vec2 shift_mm{};  // added to every sensor point, for a ghost with an offset

  [[nodiscard]] Vec2 pixel_from_sensor(Vec2 sensor_mm) const {
    return {0.5 * full_width - (sensor_mm.x + shift_mm.x) / pixel_pitch_mm - origin_x,
            0.5 * full_height + (sensor_mm.y + shift_mm.y) / pixel_pitch_mm - origin_y};
  }
  [[nodiscard]] Vec2 sensor_from_pixel(Vec2 pixel) const {
    return {(0.5 * full_width - pixel.x - origin_x) * pixel_pitch_mm - shift_mm.x,
            (pixel.y + origin_y - 0.5 * full_height) * pixel_pitch_mm - shift_mm.y};
  }
  // u, v in 0..1 over the full frame, (0, 0) top left.
  [[nodiscard]] Vec2 sensor_from_uv(Vec2 uv) const {
    return {(0.5 - uv.x) * full_width * pixel_pitch_mm, (uv.y - 0.5) * full_height * pixel_pitch_mm};
  }
  [[nodiscard]] Vec2 uv_from_sensor(Vec2 sensor_mm) const {
    return {0.5 - sensor_mm.x / (full_width * pixel_pitch_mm), 0.5 + sensor_mm.y / (full_height * pixel_pitch_mm)};
  }
};

// The largest frame of these pixel proportions inside the lens's sensor.
[[nodiscard]] CONTREJOUR_API Frame frame_on_sensor(const LensState& lens, int width, int height);

}  // namespace contrejour
