// A plot of a coated surface's reflectance over wavelength, with one line for each angle.
#pragma once

#include <string>

#include "contrejour/coating.h"
#include "contrejour/glass.h"

namespace contrejour::cli {

// coating: placed on the glass (placed_on). Returns SVG.
[[nodiscard]] std::string reflectance_plot(const Coating& coating, const Glass& glass, const std::string& title);

}  // namespace contrejour::cli
