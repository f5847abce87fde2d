// SPDX-License-Identifier: Apache-2.0
// Pictures whose pixels are not square on the sensor: renderers draw a frame of square pixels, which are then averaged
// or summed. A picture's pixel aspect (OpenEXR's pixelAspectRatio) is the width over the height of its pixels as it is
// displayed. Behind an anamorphic lens with a squeeze of 2, pixels of aspect 2 are square on the sensor.
// Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"

namespace contrejour {

struct PixelGrid {
  Frame frame;            // the rendered frame of square pixels, which contains the picture
  int width = 0, height = 0;  // pixels of the picture
  Vec2 per_pixel{1, 1};   // frame pixels per picture pixel, across and down; one of them is 1
  Vec2 corner_px;         // the picture's corner, in the frame's pixels

  [[nodiscard]] bool is_square() const { return per_pixel == Vec2{1, 1}; }
  [[nodiscard]] Vec2 sensor_from_pixel(Vec2 px) const {
    return frame.sensor_from_pixel({corner_px.x + px.x * per_pixel.x, corner_px.y + px.y * per_pixel.y});
  }
  [[nodiscard]] Vec2 pixel_from_sensor(Vec2 sensor_mm) const {
    const Vec2 from = frame.pixel_from_sensor(sensor_mm) - corner_px;
    return {from.x / per_pixel.x, from.y / per_pixel.y};
  }
};

// The grid of the window `data` of a picture `display`. The picture's middle is the axis, and the values (sensor, hfov)
// determine its size on the sensor. Errors: InvalidArgument for a window without pixels, or with more than 2^28 pixels,
// its own or square ones.
[[nodiscard]] CONTREJOUR_API Result<PixelGrid> pixel_grid(const params::Values& values, const LensState& lens,
                                                          const PixelWindow& data, const PixelWindow& display,
                                                          double pixel_aspect);

// Sums the frame's pixels over each pixel of the picture, weighted by the fraction of their area inside it.
[[nodiscard]] CONTREJOUR_API Image picture_of_frame(const Image& frame, const PixelGrid& grid);

// As picture_of_frame, for a flare, which must be finite. Errors: InvalidArgument, with the number of samples that are
// not finite.
[[nodiscard]] CONTREJOUR_API Result<Image> picture_of_flare(Image frame, const PixelGrid& grid);

// Averages the picture's pixels over each pixel of the frame, weighted by area; outside the picture they count as 0.
[[nodiscard]] CONTREJOUR_API Image frame_of_picture(const Image& picture, const PixelGrid& grid);

// The factor by which the lens's pictures are widened for display: 1 for all but anamorphic lenses.
[[nodiscard]] CONTREJOUR_API double squeeze_of(const LensState& lens);

}  // namespace contrejour
