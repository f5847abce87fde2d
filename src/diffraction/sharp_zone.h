// SPDX-License-Identifier: Apache-2.0
// Pixels about directions in which a starburst is sharper than they are.
#pragma once

#include <cstddef>

#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// The mean density over the pixel whose middle is at p from the centre (pixels, y up), `turns` half turns from straight
// down, at a fractional row of the octave: the cells' densities weighted by the lengths of the pixel's chords.
void read_zone(const SharpZone& zone, std::size_t bins, float row, float turns, Vec2 p, float* rgb);

}  // namespace contrejour::inline internal
