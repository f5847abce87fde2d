#pragma once

#include "render/interface/method.h"

namespace contrejour {

// Ours: each ghost as a smooth map fitted to a few exact rays, drawn with no more cells than its share of the
// error asks for (docs/physics/adaptive.md).
[[nodiscard]] Result<DrawnFlare> render_adaptive(const LensState& lens, const FramePlan& plan,
                                                 const RenderSettings& settings, const Context& context);

inline constexpr Method kAdaptive{"adaptive", {.spends_error = true}, render_adaptive};

}  // namespace contrejour
