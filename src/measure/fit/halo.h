// SPDX-License-Identifier: Apache-2.0
// Light scattered about a light's own image, which ghosts are fitted without.
// Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/vec.h"
#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

// Subtracts from each channel a function of the distance from the light's image: a low quantile over all directions,
// most of which no ghost covers. What the subtraction leaves uncertain is added to the variance. Pixels within
// `masked_px` of the image get no weight.
void subtract_halo(FitStation& station, Vec2 light_px, double masked_px);

}  // namespace contrejour::inline internal
