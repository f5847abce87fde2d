// SPDX-License-Identifier: Apache-2.0
// Fits the polynomials of a ghost without axial symmetry over a rectangle of light directions.
#pragma once

#include "polynomial/asymmetric_rays.h"

namespace contrejour::inline internal::polynomial {

// place: its directions and whether it is even. A zone that does not reach the accuracy is Traced, without polynomials;
// its bounds remain, so that the field can be divided where there is light.
[[nodiscard]] AsymmetricZone fit_asymmetric_zone(const AsymmetricProblem& problem, const AsymmetricZone& place);

}  // namespace contrejour::inline internal::polynomial
