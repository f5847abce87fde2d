// Lights with a size, for any method: docs/physics/area-lights.md.
#pragma once

#include <span>

#include "render/interface/frame_plan.h"

namespace contrejour {

// As render_planned, for lights of which some are no points. Errors: those of planning and of the method.
[[nodiscard]] Result<Flare> render_areas(PlannedRenderer method, const LensState& lens, std::span<const Light> lights,
                                         const RenderSettings& settings, const Context& context);

}  // namespace contrejour
