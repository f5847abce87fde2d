// SPDX-License-Identifier: Apache-2.0
// A C caller's pixels: checked, read into an Image, written from one. Thread-safety: pure functions, but for the pixels
// that they write.
#pragma once

#include "c_interface/boundary.h"
#include "contrejour/image.h"
#include "contrejour/image_view.h"

namespace contrejour::inline internal {

// The view of a caller's image, with the steps that it leaves out. Errors: InvalidArgument for NULL, for sizes below 1
// or above 2^28 pixels, for steps with which samples overlap.
[[nodiscard]] Result<ImageView> view_of(const cj_image* image);

// The three channels of all pixels.
[[nodiscard]] Image read_pixels(const ImageView& view);

// Writes the samples of `to` that differ from those of `before`, so that all others keep their bits; both are of the
// view's size. A half-float sample becomes the nearest to its value, or the largest.
void write_changes(const Image& before, const Image& to, const ImageView& view);

}  // namespace contrejour::inline internal
