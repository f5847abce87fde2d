// As few of a plan's wavelengths as each ghost can do with, where a method draws every one by itself (bundle, tiled).
#pragma once

#include <optional>

#include "render/interface/frame_plan.h"

namespace contrejour {

// The plan with `passes` of each pair. Three bands of like visible light are halved, and halved again, until the images
// of a ghost at the two ends of each lie within a pixel and a half, or it has one pass. A band is drawn at its middle
// pass with the light of all of them, as a few rays of the ghost carry it: the flux of each channel is that of all
// passes to 2 per cent. A plan whose wavelengths were asked for stays as it is. None when cancelled.
[[nodiscard]] std::optional<FramePlan> with_passes_by_need(const FramePlan& plan, const LensState& lens,
                                                           const Frame& frame, const Context& context);

}  // namespace contrejour
