// SPDX-License-Identifier: Apache-2.0
// The colour of daylight (D65) reflected by a coated surface at normal incidence.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contrejour/expert/colour.h"

namespace contrejour::cli {

// The wavelengths, in nm, at which reflectances are needed: the whole visible spectrum.
[[nodiscard]] std::vector<double> reflected_wavelengths_nm();

// XYZ of the reflection from reflectances at those wavelengths; Y is the luminous reflectance, 1 for a mirror.
[[nodiscard]] Xyz reflected_colour(std::span<const double> reflectance);

// "#8060ff": the colour at full brightness in sRGB.
[[nodiscard]] std::string srgb_text(const Xyz& xyz);
// The chromaticity of such a text, or of "R,G,B", scene-linear. Errors: it is neither, or black.
[[nodiscard]] Result<std::array<double, 2>> parse_chromaticity(const std::string& text);

}  // namespace contrejour::cli
