// Corners of what is drawn of a cell.
#pragma once

#include <array>
#include <cstddef>

#include "contrejour/vec.h"
#include "render/adaptive/maps/patch.h"

namespace contrejour::adaptive {

// A corner of a polygon with what may cut it: stop coordinates, two a crossing, then squared heights at rims.
struct Corner {
  Vec2 position;  // pixels of the frame
  Vec2 uv;        // in the cell or triangle: shares of areas there are shares of flux
  std::array<float, 2 * kMaxStopCrossings + kMostRims> limit{};
};

}  // namespace contrejour::adaptive
