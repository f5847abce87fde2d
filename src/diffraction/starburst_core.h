// SPDX-License-Identifier: Apache-2.0
// The middle of a starburst, precomputed for any subpixel position of its centre.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/vec.h"
#include "contrejour/image.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// Pixels are counted in int; a starburst that far outside is not visible.
[[nodiscard]] inline bool is_drawable(Vec2 centre_px) {
  return std::abs(centre_px.x) < 1e8 && std::abs(centre_px.y) < 1e8;
}

// Adds densities to a row of pixels, rgb[3 x + c], where their middles lie within kNear_px of the centre; y: distance
// of the row's middle below the centre.
void add_near_row(const NearField& near, Vec2 centre_px, double y, std::size_t width, float* rgb);

}  // namespace contrejour::inline internal
