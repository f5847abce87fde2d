// SPDX-License-Identifier: Apache-2.0
// A request for a lens's ghosts, read from the command's values.
#pragma once

#include "contrejour/expert/parameter_values.h"
#include "contrejour/ghost_figures.h"

namespace contrejour::cli {

// A request for the first of the lights. Errors: those of params::lights().
[[nodiscard]] Result<FiguresRequest> figures_request(const params::Values& values, const LensState& lens);

}  // namespace contrejour::cli
