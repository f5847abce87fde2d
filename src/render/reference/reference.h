#pragma once

#include "render/interface/frame_plan.h"

namespace contrejour {

// The truth in every test: double precision, dense cells with exact footprints, no shortcut that other
// renderers use.
[[nodiscard]] Result<DrawnFlare> render_reference(const LensState& lens, const FramePlan& plan,
                                                  const RenderSettings& settings, const Context& context);

}  // namespace contrejour
