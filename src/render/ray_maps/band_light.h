// SPDX-License-Identifier: Apache-2.0
// Chooses the passes of a band at which transmittances are traced. Few are enough for most bands, since transmittances
// vary smoothly with the wavelength.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/ray_maps/band.h"
#include "render/ray_maps/first_rays.h"

namespace contrejour::inline internal::ray_maps {

// A band's light as the sum of the transmittances of some of its passes, times the gains of each.
struct BandLight {
  std::vector<std::size_t> passes;
  std::vector<Rgb> gains;
};

// Chooses as few passes as determine the light of all of the band's passes at the nodes of the first rays, within their
// tolerance. band_count: the number of bands, which share that tolerance.
[[nodiscard]] BandLight light_of_band(const FirstRays& rays, const Band& band, std::span<const PlannedPass> passes,
                                      std::size_t band_count);

}  // namespace contrejour::inline internal::ray_maps
