// SPDX-License-Identifier: Apache-2.0
// The streaks that the images of moving points of light leave on the sensor.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/frame_motion.h"

namespace contrejour::inline internal {

// The imaged lights; those that are the frame's own points of light have the shape of the line that their image moves
// along in the frame of this lens, weighed as the motion's times are, unless they hardly move.
[[nodiscard]] std::vector<Light> streaked_lights(const LensState& lens, std::span<const Light> imaged,
                                                 std::span<const Light> lights, const FrameMotion& motion);

}  // namespace contrejour::inline internal
