// SPDX-License-Identifier: Apache-2.0
// A caller's pixels as a renderer writes them: a host's buffer, a window's texture, an Image.
// Thread-safety: a plain value; write_pixels() is a pure function but for the pixels that it writes.
#pragma once

#include <cstddef>

#include "contrejour/context.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

enum class PixelType { Float, Half };

// The steps are in bytes and may be negative: hosts whose rows run from the bottom up give the address of the last row
// and a negative row_step. Samples need not be aligned.
struct ImageView {
  void* pixels = nullptr;  // the red sample of the top left pixel
  int width = 0, height = 0;
  PixelType type = PixelType::Float;
  std::ptrdiff_t channel_step = sizeof(float);  // from red to green to blue; what lies beyond blue is not touched
  std::ptrdiff_t pixel_step = 3 * sizeof(float);
  std::ptrdiff_t row_step = 0;
};

// All of an image with three channels or more.
[[nodiscard]] CONTREJOUR_API ImageView view_of(Image& image);

// Errors: InvalidArgument for a view that is not of the picture's size, that has no pixels, or whose steps are smaller
// than a sample.
[[nodiscard]] CONTREJOUR_API Result<void> check_view(const ImageView& view, int width, int height);

// Writes an image of three channels to a view of the same size. A half-float sample becomes the nearest to its value;
// values beyond the type's range become its largest. Errors: those of check_view(); Cancelled, which leaves the
// pixels written in part.
[[nodiscard]] CONTREJOUR_API Result<void> write_pixels(const Image& image, const ImageView& to,
                                                       const Context& context = {});

}  // namespace contrejour
