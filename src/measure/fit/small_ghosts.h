// SPDX-License-Identifier: Apache-2.0
// Ghosts of a few pixels, and bright cores of larger ones: found as spots in full resolution and fitted to windows
// about them, from which their surroundings' level is subtracted, so that no larger ghost that is still unknown is in
// the way. Thread-safety: as flare_fit_state.h.
#pragma once

#include "measure/fit/flare_fit_state.h"

namespace contrejour::inline internal {

// Adds small ghosts up to the given number, or until no spot stands out.
void find_small_ghosts(FlareFit& fit, int most);

// The last fit of all of them, with as many coefficients as make the stations held out likeliest.
void finish_small_ghosts(FlareFit& fit);

}  // namespace contrejour::inline internal
