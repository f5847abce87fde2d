// SPDX-License-Identifier: Apache-2.0
// The same frame on a device: pupils are searched here, and their grids are traced and drawn there.
#pragma once

#include <string>

#include "render/bundle/ghost_grid.h"
#include "render/device/kept_device.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal::bundle {

// Names what keeps a device from drawing a frame, in words for a report; empty: it can draw the frame.
[[nodiscard]] std::string device_lacks(const GridSource& source, const FramePlan& plan);

// Errors: those of the device; Cancelled.
[[nodiscard]] Result<DrawnFlare> draw_on_device(KeptDevice& kept, const GridSource& source, const PlannedFrame& planned,
                                                const FramePlan& plan, const Context& context);

}  // namespace contrejour::inline internal::bundle
