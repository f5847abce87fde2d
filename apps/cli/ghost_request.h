// A request for a lens's ghosts, read from the command's values.
#pragma once

#include "contrejour/ghost_figures.h"
#include "contrejour/parameter_values.h"

namespace contrejour::cli {

// A request for the first of the lights. Errors: those of params::lights().
[[nodiscard]] Result<FiguresRequest> figures_request(const params::Values& values, const LensState& lens);

}  // namespace contrejour::cli
