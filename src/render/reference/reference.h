#pragma once

#include "contrejour/render.h"

namespace contrejour {

// The truth in every test: double precision, dense cells with exact footprints, no shortcut that other
// renderers use.
[[nodiscard]] Result<Flare> render_reference(const LensState& lens, std::span<const Light> lights,
                                             const RenderSettings& settings, const Context& context);

}  // namespace contrejour
