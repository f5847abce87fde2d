// SPDX-License-Identifier: Apache-2.0
// The starburst of one light in a frame, as add_starburst() takes it. Units: pixels.
// Thread-safety: plain values.
#pragma once

#include <cstddef>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/starburst.h"

namespace contrejour::inline internal {

struct PlacedStarburst {
  Starburst pattern;  // with rings
  Vec2 centre_px;  // is_drawable()
  Rgb flux{};
};

// With more lights, it is faster to lay their patterns out once, as the CPU does.
inline constexpr std::size_t kMostPlacedStarbursts = 64;  // that a device draws in a frame

}  // namespace contrejour::inline internal
