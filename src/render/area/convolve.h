// Pictures times kernels.
#pragma once

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "render/area/kernel.h"

namespace contrejour::area {

// Adds to each pixel (x, y) of `to` the sum over the kernel's places (dx right, dy down) of its weight there times the
// picture's pixel (x - dx, y - dy). The picture is larger than `to` by what the kernel's reach asks for: its pixel
// (0, 0) is (-reach.right, -reach.down). Only what is not 0 costs time.
void add_convolved(Image& to, const Image& picture, const Kernel& kernel, const Context& context);

}  // namespace contrejour::area
