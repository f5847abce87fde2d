// Pictures times kernels.
#pragma once

#include <cstdint>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "render/area/kernel.h"

namespace contrejour::area {

enum class ConvolveMode : std::uint8_t { Write, Add };

// A part of a picture, all of which else is dark.
struct PicturePart {
  const Image& image;
  int left = 0, top = 0;  // its first pixel
};

// Each pixel (x, y) of `to` is, or gets added, the sum over the kernel's places (dx right, dy down) of its weight there
// times the picture's pixel (x - dx, y - dy). The picture is larger than `to` by what the kernel's reach asks for: its
// pixel (0, 0) is (-reach.right, -reach.down). Of a part of it all light is as far from the part's sides as the kernel
// is wide or high, less a pixel, but where the picture ends there. Only what is not 0 costs time, and what is linear
// costs little: where the sum is its middle to within about `unseen` it may be taken for it.
void convolve(Image& to, ConvolveMode mode, PicturePart picture, const Kernel& kernel, double unseen,
              const Context& context);

}  // namespace contrejour::area
