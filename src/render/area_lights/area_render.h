// SPDX-License-Identifier: Apache-2.0
// Renders lights with a size, with any method: docs/physics/area-lights.md.
#pragma once

#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// Like render_planned, for lights at least one of which has a size. Errors: those of planning and of the method, and
// InvalidArgument for an area_error out of range.
[[nodiscard]] Result<GhostImages> render_areas(const DrawPlan& draw, const FrameRequest& frame, const Context& context);

}  // namespace contrejour::inline internal
