// Pixels about directions in which a starburst is sharper than they are.
#pragma once

#include <cstddef>

#include "diffraction/starburst_rings.h"

namespace contrejour {

// The mean density over the pixel whose middle is at p from the centre (pixels, y up), `turns` half turns from straight
// down, at a row of the octave and the way to the next: each cell's density at the pixel's chord there, by its length.
void read_zone(const SharpZone& zone, std::size_t bins, float row, float turns, Vec2 p, float* rgb);

}  // namespace contrejour
