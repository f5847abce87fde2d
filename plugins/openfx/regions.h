// SPDX-License-Identifier: Apache-2.0
// The rectangles of a frame and its pixels. A host's canonical coordinates have y upwards and square pixels in full
// resolution; its pixels have a scale and an aspect; the library's pixels are the same with rows from the top.
// Thread-safety: pure functions of an instance.
#pragma once

#include <optional>

#include "contrejour/image_io.h"
#include "openfx/instance.h"

namespace contrejour::openfx {

struct PixelScale {
  double x = 1.0, y = 1.0;  // the host's render scale
  double pixel_aspect = 1.0;

  [[nodiscard]] PixelScale in_full_resolution() const { return {1.0, 1.0, pixel_aspect}; }
};

// The region of definition of the source, if it has one with an end.
[[nodiscard]] std::optional<RectD> source_region(const Instance& instance, Time time);

// The user's choice of the sensor's frame.
[[nodiscard]] SensorFrame sensor_frame_choice(const Instance& instance, Time time);

// The rectangle that the lens's sensor sees: the project's, or the source's.
[[nodiscard]] RectD sensor_frame(const Instance& instance, Time time, SensorFrame choice);

// The rectangle in which the effect gives pixels: the sensor's frame and the source.
[[nodiscard]] RectD output_region(const Instance& instance, Time time, SensorFrame choice);

// A region that the host gave while it renders at a scale, in canonical coordinates. MLT's are of the scaled picture.
[[nodiscard]] RectD canonical(const Instance& instance, const RectD& region, const PixelScale& scale);

// The pixels that a rectangle touches, rows from the top: y = 0 lies above the host's row -1.
[[nodiscard]] PixelWindow pixels_of(const RectD& canonical, const PixelScale& scale);

}  // namespace contrejour::openfx
