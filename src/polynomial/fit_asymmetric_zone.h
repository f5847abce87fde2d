// SPDX-License-Identifier: Apache-2.0
// Fits the polynomials of a ghost without axial symmetry over a rectangle of light directions.
#pragma once

#include "polynomial/asymmetric_basis.h"
#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {

struct AsymmetricProblem {
  const LensPolynomials& lens;  // without ghosts
  const PolynomialOptions& options;
  const GhostRays& rays;
  Vec2 sensor_half_mm;
};

// place: its directions and whether it is even. A zone that does not reach the accuracy is Traced, without polynomials;
// its bounds remain, so that the field can be divided where there is light.
[[nodiscard]] AsymmetricZone fit_asymmetric_zone(const AsymmetricProblem& problem, const AsymmetricZone& place);

// The zone with bounds of light at all directions of its grid.
[[nodiscard]] AsymmetricZone with_bounds(const AsymmetricProblem& problem, const AsymmetricZone& place);

}  // namespace contrejour::inline internal::polynomial
