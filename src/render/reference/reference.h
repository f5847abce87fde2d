#pragma once

#include "render/interface/method.h"

namespace contrejour {

// The truth in every test: double precision, dense cells with exact footprints, no shortcut that other
// renderers use.
[[nodiscard]] Result<DrawnFlare> render_reference(const LensState& lens, const FramePlan& plan,
                                                  const RenderSettings& settings, const Context& context);

inline constexpr Method kReference{"reference", {.is_exact = true, .is_slow = true}, render_reference};

}  // namespace contrejour
