// SPDX-License-Identifier: Apache-2.0
// From a disc that was found to a ghost that can be fitted.
// Thread-safety: pure functions.
#pragma once

#include <span>

#include "contrejour/expert/fit_flare.h"
#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

// A sharp disc with the level that it has in the pictures, with a few coefficients for each curve.
[[nodiscard]] MeasuredGhost start_of_ghost(const FoundGhost& found, std::span<const FitStation> residuals,
                                           double s_max);

// The light of ghosts larger than the picture: a disc that covers it, whose level alone is seen.
[[nodiscard]] MeasuredGhost start_of_veil(std::span<const FitStation> stations, double s_max);

// A ghost with more (or fewer) coefficients in all its curves: 0 is the fewest.
[[nodiscard]] MeasuredGhost with_degree(MeasuredGhost ghost, int degree);

}  // namespace contrejour::inline internal
