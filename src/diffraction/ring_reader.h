// A starburst's density at places: rows and directions of its rings interpolated.
#pragma once

#include <cstddef>

#include "diffraction/starburst_rings.h"

namespace contrejour {

// At count places (x0 + i, y) pixels right of and below the centre: rgb[3 i + c]. 0 within the first row and beyond
// the radius.
void read_rings(const StarburstRings& rings, double x0, double y, std::size_t count, float* rgb);

}  // namespace contrejour
