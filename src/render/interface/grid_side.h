// How many rays a side a ghost's grid has: bodonyi2023 eq. 13.
#pragma once

#include "contrejour/lens.h"
#include "contrejour/method_options.h"
#include "contrejour/result.h"
#include "ghosts/ray_grid.h"

namespace contrejour {

// Rays a side from 4, which do for well-behaved ghosts (hullin2011 7.1), to 512; sigma and phi in their ranges.
[[nodiscard]] Result<void> check_grid(const GridOptions& grid);

// grid.rays, or with grid.scale fewer, down to `fewest`, by the fraction of the sensor that the ghost covers.
[[nodiscard]] int grid_side(const GridOptions& grid, const LensState& lens, const Rectangle& on_sensor, int fewest);

}  // namespace contrejour
