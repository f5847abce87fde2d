// SPDX-License-Identifier: Apache-2.0
// Convolution of images with kernels.
#pragma once

#include <cstdint>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "render/area_lights/kernel.h"

namespace contrejour::inline internal::area {

enum class ConvolveMode : std::uint8_t { Write, Add };

// A part of a picture that is dark elsewhere.
struct PicturePart {
  const Image& image;
  int left = 0, top = 0;  // its first pixel
};

// Sets each pixel (x, y) of `to` to, or adds to it, the sum over the kernel's offsets (dx right, dy down) of the weight
// times the picture's pixel (x - dx, y - dy). The picture is larger than `to` by the kernel's reach: its pixel (0, 0)
// is (-reach.right, -reach.down). If only a part of the picture is given, all light is at least the kernel's width or
// height, minus a pixel, from the part's sides, except where the picture itself ends. Zeros cost no time, and linear
// regions little: where the sum equals its central pixel to within about `negligible_level`, that pixel may be used.
void convolve(Image& to, ConvolveMode mode, PicturePart picture, const Kernel& kernel, double negligible_level,
              const Context& context);

}  // namespace contrejour::inline internal::area
