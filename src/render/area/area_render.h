// Lights with a size, for any method: docs/physics/area-lights.md.
#pragma once

#include "render/interface/frame_plan.h"

namespace contrejour {

// As render_planned, for lights of which some are no points. Errors: those of planning and of the method, and
// InvalidArgument for an area_error out of range.
[[nodiscard]] Result<Flare> render_areas(const DrawPlan& draw, const FrameRequest& frame, const Context& context);

}  // namespace contrejour
