// SPDX-License-Identifier: Apache-2.0
// A sweep as a heat map with one row for each ghost, the worst first, and one column for each step. Colours are on a
// logarithmic scale.
#pragma once

#include <string>

#include "cli/ghost_sweep.h"

namespace contrejour::cli {

// The SVG of a sorted sweep, of at most kMaxHeatMapRows ghosts.
inline constexpr std::size_t kMaxHeatMapRows = 80;
[[nodiscard]] std::string heat_map(const GhostSweep& sweep, SweepQuantity quantity);

}  // namespace contrejour::cli
