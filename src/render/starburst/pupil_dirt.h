// Dirt as a light's own image sees it: from where it lies into the direction cosines of the exit pupil's mask.
#pragma once

#include <cstddef>
#include <vector>

#include "contrejour/lens_starburst.h"
#include "render/starburst/pupil_rays.h"

namespace contrejour {

// Dims the mask, takes what dirt blocks from its flux, and gives its outline the shapes. used: rays that get through or
// all but do; degree: of the polynomials through them; power_mm2: what the clean mask lets through, in its own units.
void add_dirt(const LensState& lens, const LightSource& light, const PupilRays& pupil,
              const std::vector<std::size_t>& used, int degree, double power_mm2, ExitPupil& out);

}  // namespace contrejour
