// SPDX-License-Identifier: Apache-2.0
// Ghosts of a few pixels, and bright cores of larger ones: found as spots in full resolution and fitted to windows
// about them, from which their surroundings' level is subtracted, so that no larger ghost that is still unknown is in
// the way. Thread-safety: as flare_fit_state.h.
#pragma once

#include <optional>
#include <vector>

#include "measure/fit/flare_fit_state.h"

namespace contrejour::inline internal {

// Adds small ghosts up to the given number, or until no spot stands out.
void find_small_ghosts(FlareFit& fit, int most);

// The last fit of all of them, with as many coefficients as make the stations held out likeliest.
void finish_small_ghosts(FlareFit& fit);

// The ghost that a spot becomes in windows about it, or none if the pictures do not become likelier by more than
// chance. residuals: in full size, without all other ghosts.
[[nodiscard]] std::optional<MeasuredGhost> fitted_spot(FlareFit& fit, const std::vector<FitStation>& residuals,
                                                       const FoundGhost& found);

}  // namespace contrejour::inline internal
