// SPDX-License-Identifier: Apache-2.0
// The light of one ghost of one light on the sensor: integrals over its pupil, from few exact rays.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/ghost.h"
#include "render/pupils/footprint.h"
#include "render/pupils/ghost_pupil.h"

namespace contrejour::inline internal::pupils {

// A ghost's footprint at one of the request's wavelengths; fluxes to 1e-3.
[[nodiscard]] Footprint footprint_of(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm,
                                     const IrisShape& iris);

// The flux of a ghost that lands inside a rectangle of the sensor, mm^2 at E0 = 1, at each of some wavelengths: to
// about a hundredth of its whole flux. The pupil and the footprint are found at the request's middle wavelength; at the
// others the same rays give the reflectances. searched: from search_ghost_pupil() or find_ghost_pupil().
[[nodiscard]] std::vector<double> approximate_fluxes_within(const PupilRequest& request, const GhostPupil& searched,
                                                            std::span<const double> lambda_nm, const IrisShape& iris,
                                                            const Rectangle& sensor_mm);

}  // namespace contrejour::inline internal::pupils
