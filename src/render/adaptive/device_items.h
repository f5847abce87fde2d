// SPDX-License-Identifier: Apache-2.0
// The frame on a device: the ghosts and lights are listed here; pupils, rays, cells and pixels are found there.
#pragma once

#include <string>

#include "contrejour/method_options.h"
#include "render/device/kept_device.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal::adaptive {

// Names what keeps a device from drawing a frame, in words for a report; empty: it can draw the frame.
[[nodiscard]] std::string device_lacks(const PlannedFrame& planned);

// Errors: those of the device; Cancelled.
[[nodiscard]] Result<DrawnFlare> draw_on_device(KeptDevice& kept, const PlannedFrame& planned,
                                                const AdaptiveOptions& options, const Context& context);

}  // namespace contrejour::inline internal::adaptive
