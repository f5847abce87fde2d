// Pictures whose pixels are not square where they lie on the sensor: renderers draw square ones, which are then added
// up. A picture's pixel aspect (OpenEXR's pixelAspectRatio) is the width over the height of its pixels as it is shown.
// A lens that squeezes the picture undoes it: behind an anamorphic lens of 2x the pixels of aspect 2 are square.
// Thread-safety: pure functions.
#pragma once

#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour {

struct PixelGrid {
  Frame frame;            // of square pixels, that holds the picture: what is rendered
  int width = 0, height = 0;  // of the picture
  Vec2 per_pixel{1, 1};   // the frame's pixels a pixel of the picture, across and down; one of them is 1
  Vec2 corner_px;         // of the picture, in the frame's pixels

  [[nodiscard]] bool is_square() const { return per_pixel == Vec2{1, 1}; }
  [[nodiscard]] Vec2 sensor_from_pixel(Vec2 px) const {
    return frame.sensor_from_pixel({corner_px.x + px.x * per_pixel.x, corner_px.y + px.y * per_pixel.y});
  }
  [[nodiscard]] Vec2 pixel_from_sensor(Vec2 sensor_mm) const {
    const Vec2 from = frame.pixel_from_sensor(sensor_mm) - corner_px;
    return {from.x / per_pixel.x, from.y / per_pixel.y};
  }
};

// The part `data` of a whole picture `display`, whose middle is the axis and which lies on the lens's sensor as values
// say (sensor, hfov). Errors: InvalidArgument for windows without pixels or beyond 2^28 of them, also of square ones.
[[nodiscard]] Result<PixelGrid> pixel_grid(const params::Values& values, const LensState& lens, const PixelWindow& data,
                                           const PixelWindow& display, double pixel_aspect);

// Each pixel of the picture: the sum of what the frame has within it, by area.
[[nodiscard]] Image picture_of_frame(const Image& frame, const PixelGrid& grid);

// The same of a flare, which must be finite. Errors: InvalidArgument, with the number of samples that are not.
[[nodiscard]] Result<Image> picture_of_flare(Image frame, const PixelGrid& grid);

// Each pixel of the frame: the mean of the picture's that it lies in, by area; nothing beside the picture.
[[nodiscard]] Image frame_of_picture(const Image& picture, const PixelGrid& grid);

// How many times wider than high the lens's pictures are to be shown: 1 for all but anamorphic lenses.
[[nodiscard]] double squeeze_of(const LensState& lens);

}  // namespace contrejour
