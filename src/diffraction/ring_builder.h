// SPDX-License-Identifier: Apache-2.0
// Rings of a starburst from its pattern at one wavelength: hullin2011 3.3, one power spectrum scaled by wavelength.
#pragma once

#include <memory>

#include "contrejour/context.h"
#include "diffraction/band_shifts.h"
#include "diffraction/starburst_pattern.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// rho_per_px: at the wavelength with shift 0. Null when cancelled.
[[nodiscard]] std::shared_ptr<const StarburstRings> build_rings(const StarburstPattern& pattern,
                                                                const BandShifts& shifts, double rho_per_px,
                                                                double radius_px, const Context& context);

}  // namespace contrejour::inline internal
