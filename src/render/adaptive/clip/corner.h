// SPDX-License-Identifier: Apache-2.0
// Corners of the polygons that cells are drawn as.
#pragma once

#include <array>
#include <cstddef>

#include "contrejour/expert/vec.h"
#include "render/adaptive/cells/ray_map_names.h"

namespace contrejour::inline internal::adaptive {

// A corner of a polygon with the fields that may clip it: two stop coordinates a crossing, then squared heights at
// rims.
struct Corner {
  Vec2 position;  // pixels of the frame
  Vec2 uv;        // in the cell or triangle: fractions of area there are fractions of flux
  std::array<float, 2 * kMaxStopCrossings + kMaxRims> limit{};
};

}  // namespace contrejour::inline internal::adaptive
