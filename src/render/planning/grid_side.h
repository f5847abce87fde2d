// SPDX-License-Identifier: Apache-2.0
// The number of rays on a side of a ghost's grid: bodonyi2023 eq. 13.
#pragma once

#include "contrejour/lens.h"
#include "contrejour/method_options.h"
#include "contrejour/result.h"
#include "ghosts/ray_grid.h"

namespace contrejour::inline internal {

// Checks that there are from 4 rays a side, enough for well-behaved ghosts (hullin2011 7.1), to 512, and that sigma and
// phi are within their ranges.
[[nodiscard]] Result<void> check_grid(const GridOptions& grid);

// grid.rays; with grid.scale fewer rays, but at least `min_count`, by the fraction of the sensor that the ghost covers.
[[nodiscard]] int grid_side(const GridOptions& grid, const LensState& lens, const Rectangle& on_sensor, int min_count);

}  // namespace contrejour::inline internal
