// SPDX-License-Identifier: Apache-2.0
// The light inside ghosts: caustics, rings and cores, which one level does not follow.
// Thread-safety: changes the state that it is given.
#pragma once

#include "measure/fit/flare_fit_state.h"

namespace contrejour::inline internal {

// Gives profiles to the ghosts of the whole flare, with as many coefficients over the angle as make the stations held
// out likeliest, and fits the outlines anew with them. Keeps the flare as it was if no profile helps.
void fit_profiles(FlareFit& fit);

}  // namespace contrejour::inline internal
