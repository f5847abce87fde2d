// SPDX-License-Identifier: Apache-2.0
// Renders lights with a size, and points of light that move with the lens, with any method:
// docs/physics/area-lights.md, docs/physics/motion-blur.md.
#pragma once

#include "contrejour/expert/frame_motion.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// Like render_planned, for lights at least one of which has a size. Errors: those of planning and of the method, and
// InvalidArgument for an area_error out of range.
[[nodiscard]] Result<GhostImages> render_areas(const DrawPlan& draw, const FrameRequest& frame, const Context& context);

// The same for points of light, as many as the motion has: the mean over the times that the motion stands for.
[[nodiscard]] Result<GhostImages> render_moving(const DrawPlan& draw, const FrameRequest& frame,
                                                const FrameMotion& motion, const Context& context);

}  // namespace contrejour::inline internal
