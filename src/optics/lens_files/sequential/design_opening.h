// Apertures of design programs on our surfaces.
#pragma once

#include <string>
#include <vector>

#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour {

// Semi-diameter, rim and obscuration of a surface whose shape is set. Warns of what is taken otherwise.
void set_opening(const DesignSurface& from, double unit_mm, Surface& surface, std::vector<std::string>& warnings);

// Of a surface that is turned about its axis.
void turn_opening(double turn_rad, ClearAperture& aperture);
void turn_opening(double turn_rad, Obscuration& obscuration);

}  // namespace contrejour
