// What a coated surface's reflection looks like: of daylight (D65), straight on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contrejour/colour.h"

namespace contrejour::cli {

// Wavelengths, nm, at which reflectances are asked for: all of the visible spectrum.
[[nodiscard]] std::vector<double> reflected_wavelengths_nm();

// XYZ of the reflection for reflectances at those wavelengths; Y is the luminous reflectance, 1 for a mirror.
[[nodiscard]] Xyz reflected_colour(std::span<const double> reflectance);

// "#8060ff": the colour at full brightness, as screens show it (sRGB).
[[nodiscard]] std::string shown_as(const Xyz& xyz);
// Chromaticity of such a text, or of "R,G,B", scene-linear; none if it is neither, or black.
[[nodiscard]] Result<std::array<double, 2>> parse_chromaticity(const std::string& text);

}  // namespace contrejour::cli
