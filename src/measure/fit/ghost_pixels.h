// SPDX-License-Identifier: Apache-2.0
// The pixels of one station that a ghost reaches, with its weights there and their derivatives.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contrejour/expert/measured_flare.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kShapeCurves = 10;  // of curves_of(): all but the levels

// A station's pixels around the optical axis. The ghosts' x axis points to the light.
struct StationFrame {
  TangentFrame pixels;
  Vec2 to_light{1.0, 0.0};  // unit, y up
};

struct GhostPixel {
  std::uint32_t index = 0;  // y * width + x
  ShadeWeights weights;
  std::array<ShadeWeights, kShapeCurves> by_shape;  // derivatives with respect to the values of curves 0..9
};

// In rising order of their indices.
[[nodiscard]] std::vector<GhostPixel> ghost_pixels(const GhostAtAngle& ghost, const StationFrame& frame);

}  // namespace contrejour::inline internal
