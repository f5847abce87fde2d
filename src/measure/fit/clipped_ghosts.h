// SPDX-License-Identifier: Apache-2.0
// Ghosts that a second aperture of the lens cuts to a segment or a lune as the light leaves the axis.
// Thread-safety: changes the state that it is given.
#pragma once

#include "measure/fit/flare_fit_state.h"

namespace contrejour::inline internal {

// Gives each ghost a circle that cuts it, if the stations that are fitted and those that are held out are likelier with
// it. A ghost that has one is there up to the largest angle: what cuts it makes it vanish.
void fit_clipping(FlareFit& fit);

}  // namespace contrejour::inline internal
