#pragma once

#include "render/interface/frame_plan.h"

namespace contrejour {

// Ours: each ghost as a smooth map fitted to a few exact rays, drawn with no more cells than its share of the
// error asks for (docs/physics/adaptive.md).
[[nodiscard]] Result<DrawnFlare> render_adaptive(const LensState& lens, const FramePlan& plan,
                                                 const RenderSettings& settings, const Context& context);

}  // namespace contrejour
