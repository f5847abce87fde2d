// SPDX-License-Identifier: Apache-2.0
// The value of a LENS argument: a bundled lens or a lens file, or a measured flare (`.flare.toml`).
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/measured_settings.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/source_renderer.h"

namespace contrejour::cli {

// Opens the lens with open_lens(), or reads the measured flare. Errors: those of open_lens() and read_flare(); values
// that a measured flare cannot follow.
[[nodiscard]] Result<FlareSource> open_source(const std::string& lens, const params::Values& values, MeasuredUse use);

// As contrejour::renderer_of(), with a warning where the CPU stands in for another device.
[[nodiscard]] Result<SourceRenderer> open_renderer(const params::Values& values, const FlareSource& source);

[[nodiscard]] const std::string& name_of(const FlareSource& source);

// The same lights; with a measured flare in the exposure that the values state (walch2018 eq. 2), and warnings for
// those beyond its angles. Errors: those of exposed_lights().
[[nodiscard]] Result<std::vector<Light>> scaled_lights(const FlareSource& source, Result<std::vector<Light>> lights,
                                                       const params::Values& values);

}  // namespace contrejour::cli
