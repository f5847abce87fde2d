// SPDX-License-Identifier: Apache-2.0
// Fits one ghost's polynomials over a zone of the field.
#pragma once

#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {

struct ZoneProblem {
  const LensPolynomials& lens;  // without ghosts
  const PolynomialOptions& options;
  const GhostRays& rays;
  Vec2 sensor_half_mm;
};

// field_low, field_high: tangents. A zone that does not reach the accuracy is Traced, without polynomials.
[[nodiscard]] PolynomialZone fit_zone(const ZoneProblem& problem, double field_low, double field_high);

}  // namespace contrejour::inline internal::polynomial
