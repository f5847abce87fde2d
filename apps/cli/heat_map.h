// SPDX-License-Identifier: Apache-2.0
// A sweep as a picture: one row for each ghost, the worst first; one column for each step; colours by decades.
#pragma once

#include <string>

#include "cli/ghost_sweep.h"

namespace contrejour::cli {

// The SVG of a sorted sweep, of at most kMostRows ghosts.
inline constexpr std::size_t kMostRows = 80;
[[nodiscard]] std::string heat_map(const GhostSweep& sweep, SweepQuantity quantity);

}  // namespace contrejour::cli
