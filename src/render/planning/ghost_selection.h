// SPDX-License-Identifier: Apache-2.0
// Chooses which of a lens's ghosts are rendered: hullin2011 4.2, "intensity LOD".
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame_settings.h"
#include "optics/trace/by_wavelength.h"
#include "render/planning/kept_ghost_fluxes.h"
#include "render/planning/planned_light.h"
#include "render/pupils/kept_pupils.h"

namespace contrejour::inline internal {

struct GhostChoice {
  std::vector<Ghost> ghosts;  // in (i, j) order
  // The fraction of the flux of all ghosts inside the frame that the ghosts left out carry, in the channel that loses
  // most; nullopt where it was not measured.
  std::optional<double> skipped_flux = std::nullopt;
  // The ghosts' pupils, by ghost and then by light, if the selection had to find them.
  std::vector<pupils::GhostPupil> pupils = {};
  std::vector<double> flux_fractions = {};  // each ghost's of that of all ghosts, if the ghosts were measured
};

// The figures of each ghost of a lens that a session keeps.
struct KeptByGhost {
  pupils::KeptPupils& pupils;
  KeptGhostFluxes& fluxes;
};

// Errors: InvalidArgument for a listed ghost that the lens does not have.
[[nodiscard]] Result<void> check_selection(const LensState& lens, const GhostSelection& selection);

// Ghosts are measured only where their flux decides: SelectBrightest and SelectByFlux. Their flux is what they add to
// the picture's channels inside the frame, with the lights' values and spectra and the ghosts' adjustments: a ghost is
// as bright as its largest fraction, in any channel, of the flux of all ghosts. tables: those of the lights'
// wavelengths. kept: of this lens. measures: measures the ghosts in any case. Errors: Cancelled.
[[nodiscard]] Result<GhostChoice> select_ghosts(const LensState& lens, std::span<const PlannedLight> lights,
                                                const TablesByWavelength& tables, const KeptByGhost& kept,
                                                const FrameSettings& settings, bool measures, const Context& context);

}  // namespace contrejour::inline internal
