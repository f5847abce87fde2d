// SPDX-License-Identifier: Apache-2.0
// The tolerance says how far maps may be off.
// Thread-safety: values.
#pragma once

#include <functional>

#include "render/ray_maps/lobatto_rays.h"

namespace contrejour::inline internal::ray_maps {

struct Tolerance {
  double position_px = 0, stop = 0, weight = 0;  // stop radii; relative to the largest weight
  double level = 0;  // of the ghost, as a pixel's value
  double lost_mm2 = 0;   // area of the entrance whose light one part of a box may lose
  double colour_px = 0;  // limit of wavelengths' displacement for correct colours, however dim
};

// Decides the tolerance for the ghost of a box's ray set. weight: the largest of any channel at any of its nodes, all
// wavelengths together. shared_flux: LightSource::shared_flux().
using ToleranceOf = std::function<Tolerance(const LobattoRays& ray_set, double weight, double shared_flux)>;

}  // namespace contrejour::inline internal::ray_maps
