// SPDX-License-Identifier: Apache-2.0
// The rays of a zone without axial symmetry: where they start, and the zone's pupil coordinates.
#pragma once

#include <vector>

#include "polynomial/asymmetric_basis.h"
#include "polynomial/fit_rays.h"

namespace contrejour::inline internal::polynomial {

struct AsymmetricProblem {
  const LensPolynomials& lens;  // without ghosts
  const PolynomialOptions& options;
  const GhostRays& rays;
  Vec2 sensor_half_mm;
};

// The zone with bounds of light at all directions of its grid.
[[nodiscard]] AsymmetricZone with_bounds(const AsymmetricProblem& problem, const AsymmetricZone& place);

// Chooses centres that follow the middle of the light's bounds, and radii, from the zone's bounds, of which one at
// least must have light.
void set_pupil_coordinates(AsymmetricZone& zone);

// `fields` directions that fill the zone, denser towards its border, in one half or quarter of an even zone; and for
// each, `count` points of the bounds there, denser towards their border. field_index, first: in the sequences of
// directions and points.
struct AsymmetricSampling {
  int fields = 0, count = 0;
  std::size_t field_index = 1, first = 1;
};
[[nodiscard]] std::vector<RayStart> starts_within(const AsymmetricZone& zone, const AsymmetricSampling& sampling);

// The rays that a zone is fitted to, in and around its light, from that many directions.
[[nodiscard]] FitRays fit_rays(const AsymmetricProblem& problem, const AsymmetricZone& zone, int fields);

// The mean over the zone's area of the ghost's flux. rays: of starts_within() with this number of directions.
[[nodiscard]] double flux_mm2(const AsymmetricZone& zone, const NodeRays& rays, int fields);

}  // namespace contrejour::inline internal::polynomial
