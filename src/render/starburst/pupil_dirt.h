// SPDX-License-Identifier: Apache-2.0
// Dirt in a light's direct image: from the plane that it lies in to the direction cosines of the exit pupil's mask.
#pragma once

#include <cstddef>
#include <vector>

#include "contrejour/expert/lens_starburst.h"
#include "render/starburst/pupil_rays.h"

namespace contrejour::inline internal {

// Dims the mask, subtracts what dirt blocks from its flux, and adds the shapes to its outline. used: the rays that get
// through or nearly do; degree: that of the polynomials through them; power_mm2: the clean mask's power in its own
// units.
void add_dirt(const LensState& lens, const LightSource& light, const PupilRays& pupil,
              const std::vector<std::size_t>& used, int degree, double power_mm2, ExitPupil& out);

}  // namespace contrejour::inline internal
