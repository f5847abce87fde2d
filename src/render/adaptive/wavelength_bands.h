// Wavelengths whose images of a ghost lie so close that they share one geometry.
#pragma once

#include <cstddef>
#include <vector>

#include "render/adaptive/first_rays.h"

namespace contrejour::adaptive {

// Passes from first to last without it, seen as at the one in their middle.
struct Band {
  std::size_t first = 0, last = 0;
  [[nodiscard]] std::size_t middle() const { return (first + last) / 2; }
};

// As few as the rays' tolerance allows, of about as many passes each.
[[nodiscard]] std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                                          const WavelengthSamples& samples, double pixel_pitch_mm);

}  // namespace contrejour::adaptive
