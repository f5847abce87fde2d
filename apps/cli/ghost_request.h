// What is asked about a lens's ghosts, as the command's values say.
#pragma once

#include "contrejour/ghost_figures.h"
#include "params/values.h"

namespace contrejour::cli {

// For the first of the lights. Errors: those of params::lights().
[[nodiscard]] Result<FiguresRequest> figures_request(const params::Values& values, const LensState& lens);

}  // namespace contrejour::cli
