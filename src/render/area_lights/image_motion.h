// SPDX-License-Identifier: Apache-2.0
// How the direct image of a light moves over the frame as the light moves.
#pragma once

#include "base/linear_map.h"
#include "contrejour/expert/light_source.h"
#include "contrejour/frame.h"

namespace contrejour::inline internal::area {

// The motion in pixels right and down for lights a unit to the right and up (tangents, offset_direction); kZeroMap
// where no light gets through.
[[nodiscard]] LinearMap image_motion_px(const LensState& lens, const Frame& frame, const LightSource& source);

}  // namespace contrejour::inline internal::area
