// Wavelengths whose images of a ghost lie so close that they share one geometry.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/adaptive/maps/first_rays.h"

namespace contrejour::adaptive {

// Passes from first to last without it, seen at one place: that of the one in their middle, or between them.
struct Band {
  std::size_t first = 0, last = 0;
  std::vector<double> mix{};  // of its passes' geometries, its own; empty: that of its middle
  [[nodiscard]] std::size_t middle() const { return (first + last) / 2; }
};

// As few as the rays' tolerance allows. Where samples tell all wavelengths, seen at the middle of their light.
[[nodiscard]] std::vector<Band> bands_for(const FirstRays& rays, std::span<const PlannedPass> passes,
                                          const WavelengthSamples& samples, double pixel_pitch_mm);

}  // namespace contrejour::adaptive
