// SPDX-License-Identifier: Apache-2.0
// Finds wavelengths whose images of a ghost lie so close together that they can share one geometry.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/adaptive/maps/first_rays.h"

namespace contrejour::inline internal::adaptive {

// Passes from first to last, excluding last, drawn at one position: that of the middle pass, or one between passes.
struct Band {
  std::size_t first = 0, last = 0;
  std::vector<double> mix{};  // weights of its passes' geometries; empty: that of middle()
  [[nodiscard]] std::size_t middle() const { return (first + last) / 2; }
};

// As few bands as the rays' tolerance allows. Where wavelengths are interpolated, a band is drawn at the centroid of
// its light.
[[nodiscard]] std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                                          const WavelengthSamples& samples, double pixel_pitch_mm);

}  // namespace contrejour::inline internal::adaptive
