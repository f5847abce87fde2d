// The first rays through a box of a ghost's pupil, few at each wavelength: what is decided by before the ghost is
// drawn.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "render/adaptive/maps/ghost_tracers.h"
#include "render/adaptive/maps/tolerance.h"
#include "render/interface/wavelength_samples.h"

namespace contrejour::adaptive {

struct FirstRays {
  std::vector<RaySheet> sheets;                  // one a pass, without weights; without nodes where none was traced
  std::vector<std::vector<float>> transmission;  // one a pass, at the nodes: traced, or told by the samples
  // One a pass: its transmissions over those that light_factors() make of the samples', of all nodes alike; 1 where it
  // was traced.
  std::vector<double> light;
  bool straight = false;  // light_factors() are those of straight lines
  std::size_t samples = 0;  // passes traced, in the order of the wavelength samples, which tell the others; 0: all were
  Tolerance tolerance;
};

// At all wavelengths; of many at so few of `samples` as foretell the next of them within the tolerance.
[[nodiscard]] FirstRays first_rays(GhostTracers& tracers, const WavelengthSamples& samples, const Rectangle& box,
                                   int nodes, const Frame& frame, const ErrorBudget& budget);

// The factors by which the transmissions of the first `count` samples add up to a pass's, before FirstRays::light.
[[nodiscard]] std::vector<double> light_factors(const WavelengthSamples& samples, std::size_t count, std::size_t pass,
                                                bool straight);

// A pass's light, summed over the nodes.
[[nodiscard]] std::array<double, 3> light_of(const FirstRays& rays, std::span<const PlannedPass> passes,
                                             std::size_t pass);

}  // namespace contrejour::adaptive
