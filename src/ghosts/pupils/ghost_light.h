// What one ghost of one light does on the sensor: integrals over its pupil, from few exact rays.
#pragma once

#include "contrejour/ghost.h"
#include "ghosts/pupils/footprint.h"
#include "ghosts/pupils/ghost_pupil.h"

namespace contrejour::pupils {

// Where a ghost's light lands at one of the request's wavelengths: fluxes to 1e-3.
[[nodiscard]] Footprint footprint_of(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm,
                                     const IrisShape& iris);

// Its flux, mm^2 at E0 = 1: to some thousandths, at a fifth of the cost.
[[nodiscard]] double rough_flux(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm,
                                const IrisShape& iris);

}  // namespace contrejour::pupils
