// How many rays a side a ghost's grid has: bodonyi2023 eq. 13.
#pragma once

#include "contrejour/render.h"
#include "ghosts/ray_grid.h"

namespace contrejour {

// Rays a side from 4, which do for well-behaved ghosts (hullin2011 7.1), to 512; sigma and phi in their ranges.
[[nodiscard]] Result<void> check_grid(const RenderSettings& settings);

// settings.grid, or with settings.scale_grid fewer, down to `fewest`, by the ghost's share of the sensor.
[[nodiscard]] int grid_side(const RenderSettings& settings, const LensState& lens, const Rectangle& on_sensor,
                            int fewest);

}  // namespace contrejour
