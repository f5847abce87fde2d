// SPDX-License-Identifier: Apache-2.0
// The renderer of a LENS argument: that of a lens, or a measured flare, which needs none.
#pragma once

#include <span>
#include <variant>

#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/renderer.h"

namespace contrejour::cli {

using SourceRenderer = std::variant<Renderer, MeasuredFlare>;

// A renderer that has the lens and the values' method, or the measured flare.
[[nodiscard]] Result<SourceRenderer> renderer_of(const params::Values& values, const FlareSource& source);

// The flare of lights in a frame; that of a measured flare takes the settings' frame and ignores the rest.
[[nodiscard]] Result<Flare> render(SourceRenderer& renderer, std::span<const Light> lights,
                                   const FrameSettings& settings, const Context& context);

}  // namespace contrejour::cli
