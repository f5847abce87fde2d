// SPDX-License-Identifier: Apache-2.0
// The tolerance says how far polynomials through a ghost's rays may be off, derived from the error in pixels.
#pragma once

#include <cstddef>

#include "contrejour/frame.h"
#include "render/adaptive/cells/ray_map_names.h"
#include "render/ray_maps/tolerance.h"

namespace contrejour::inline internal::adaptive {

// A ghost, or a part of one, as it appears: its level where most of its light is, as a pixel's value, and its area
// there.
struct LevelEstimate {
  double level = 0.0, area_px = 0.0;
};

// The error that may be made in everything that one call paints.
struct ErrorBudget {
  double squared_error = 0;  // pixel values squared, summed over the frame; infinite: no limit
  double peak = 1;           // of the frame's pixel values
  LevelEstimate about = {};         // estimate of the light from the preview; 0: unknown
  std::size_t pieces = 1;  // of the light, all of whose bands are displaced alike
};

// The tolerance for the ghost of a box's ray set. weight: the largest of any channel at any of its nodes, all
// wavelengths together. shared_flux: LightSource::shared_flux().
[[nodiscard]] Tolerance tolerance_for(const LobattoRays& ray_set, double weight, double shared_flux, const Frame& frame,
                                      const ErrorBudget& budget);

}  // namespace contrejour::inline internal::adaptive
