// A drawing of what a coated surface reflects, over wavelength, a line an angle.
#pragma once

#include <string>

#include "contrejour/coating.h"
#include "contrejour/glass.h"

namespace contrejour::cli {

// coating: placed on the glass (placed_on). As SVG.
[[nodiscard]] std::string reflectance_plot(const Coating& coating, const Glass& glass, const std::string& title);

}  // namespace contrejour::cli
