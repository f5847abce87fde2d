// SPDX-License-Identifier: Apache-2.0
// How bright a frame is, as foreseen from its ghosts: errors are relative to that.
#pragma once

#include <vector>

#include "contrejour/frame.h"
#include "render/area_lights/ghost_blur.h"

namespace contrejour::inline internal::area {

// The level that the brightest kPeakFraction of the frame reach, with ghosts as uniform discs.
inline constexpr double kPeakFraction = 0.002;
[[nodiscard]] double peak_of(const std::vector<GhostBlur>& ghosts, const Frame& frame);

}  // namespace contrejour::inline internal::area
