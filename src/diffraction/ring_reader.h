// SPDX-License-Identifier: Apache-2.0
// Evaluates a starburst at pixels beyond kNear_px: it interpolates rows and directions of the rings, and sums sharp
// directions over each pixel.
#pragma once

#include <cstddef>

#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// Writes the mean density of count pixels, whose middles lie (x0 + i, y) pixels right of and below the centre: rgb[3 i
// + c], 0 within kNear_px and beyond the radius.
void read_rings(const StarburstRings& rings, double x0, double y, std::size_t count, float* rgb);

}  // namespace contrejour::inline internal
