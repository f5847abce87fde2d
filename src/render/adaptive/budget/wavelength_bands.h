// SPDX-License-Identifier: Apache-2.0
// Finds wavelengths whose images of a ghost lie so close together that they can share one geometry.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/adaptive/cells/ray_map_names.h"
#include "render/ray_maps/band.h"
#include "render/ray_maps/first_rays.h"

namespace contrejour::inline internal::adaptive {

// As few bands as the rays' tolerance allows. Where wavelengths are interpolated, a band is drawn at the centroid of
// its light. pieces: the number of pieces that the light is divided into, each of which is drawn by itself.
[[nodiscard]] std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                                          const WavelengthSamples& samples, double pixel_pitch_mm,
                                          std::size_t pieces = 1);

}  // namespace contrejour::inline internal::adaptive
