// Which of a lens's ghosts a render shows: hullin2011 4.2, "intensity LOD".
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/render.h"

namespace contrejour {

struct GhostChoice {
  std::vector<Ghost> ghosts;  // in (i, j) order
  std::optional<double> skipped_flux;  // share of the flux of all ghosts that the others carry, where measured
};

// Ghosts are measured only where their flux decides: SelectBrightest and SelectByFlux.
// Errors: InvalidArgument for a listed ghost the lens does not have, Cancelled.
[[nodiscard]] Result<GhostChoice> select_ghosts(const LensState& lens, std::span<const Light> lights,
                                                const RenderSettings& settings, const Context& context);

}  // namespace contrejour
