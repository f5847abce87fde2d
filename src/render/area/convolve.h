// Pictures times kernels.
#pragma once

#include <cstdint>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "render/area/kernel.h"

namespace contrejour::area {

enum class ConvolveMode : std::uint8_t { Write, Add };

// Each pixel (x, y) of `to` is, or gets added, the sum over the kernel's places (dx right, dy down) of its weight there
// times the picture's pixel (x - dx, y - dy). The picture is larger than `to` by what the kernel's reach asks for: its
// pixel (0, 0) is (-reach.right, -reach.down), but those of its rows that are given begin with `top`, and the others
// are dark. Only what is not 0 costs time, and what is linear costs little: where the sum is its middle to within about
// `unseen` it may be taken for it.
void convolve(Image& to, ConvolveMode mode, const Image& picture, int top, const Kernel& kernel, double unseen,
              const Context& context);

}  // namespace contrejour::area
