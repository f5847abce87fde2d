// SPDX-License-Identifier: Apache-2.0
// The same frame on a device: pupils are searched here, and their grids are traced, merged and drawn there.
#pragma once

#include <string>

#include "ghosts/ray_grid.h"
#include "render/device/kept_device.h"
#include "render/planning/frame_plan.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal::tiled {

// Rays a side for a ghost's pupil that lands on a part of the sensor.
[[nodiscard]] int side_of_grid(const GridOptions& grid, const LensState& lens, const Rectangle& sensor_mm);

// Names what keeps a device from drawing a frame, in words for a report; empty: it can draw the frame.
[[nodiscard]] std::string device_lacks(const StopTransmittances& stops, const FramePlan& plan);

// Errors: those of the device; Cancelled.
[[nodiscard]] Result<DrawnFlare> draw_on_device(KeptDevice& kept, const TiledOptions& options,
                                                const StopTransmittances& stops, const PlannedFrame& planned,
                                                const FramePlan& plan, const Context& context);

}  // namespace contrejour::inline internal::tiled
