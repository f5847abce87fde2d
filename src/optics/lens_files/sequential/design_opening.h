// SPDX-License-Identifier: Apache-2.0
// Converts apertures of design programs to ours.
#pragma once

#include <string>
#include <vector>

#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

// Sets semi-diameter, rim and obscuration of a surface whose shape is set. Warns of apertures that are interpreted
// differently.
void set_opening(const DesignSurface& from, double unit_mm, Surface& surface, std::vector<std::string>& warnings);

// Rotates the opening of a surface that is rotated about its axis.
void rotate_opening(double rotation_rad, ClearAperture& aperture);
void rotate_opening(double rotation_rad, Obscuration& obscuration);

}  // namespace contrejour::inline internal
