// SPDX-License-Identifier: Apache-2.0
// One ghost fitted to what the others leave of the pictures.
// Thread-safety: changes the state that it is given.
#pragma once

#include <optional>
#include <vector>

#include "measure/fit/flare_fit_state.h"

namespace contrejour::inline internal {

// Evenly spaced stations, about ten, of those up to this tangent of the light's angle.
[[nodiscard]] std::vector<FitStation> few_stations(const std::vector<FitStation>& stations, double last);

// The ghost that a disc found becomes, or none if the pictures do not become likelier by more than chance. The first
// ghost of a flare moves the optical centre. residuals: in half the size, without all other ghosts.
[[nodiscard]] std::optional<MeasuredGhost> fitted_alone(FlareFit& fit, const std::vector<FitStation>& residuals,
                                                        const FoundGhost& found);

}  // namespace contrejour::inline internal
