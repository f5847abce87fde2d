// SPDX-License-Identifier: Apache-2.0
// A plot of a coated surface's reflectance over wavelength, with one line for each angle.
#pragma once

#include <string>

#include "contrejour/expert/coating.h"
#include "contrejour/expert/glass.h"

namespace contrejour::cli {

// Returns SVG. The coating must be placed on the glass (placed_on).
[[nodiscard]] std::string reflectance_plot(const Coating& coating, const Glass& glass, const std::string& title);

}  // namespace contrejour::cli
