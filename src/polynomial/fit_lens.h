// SPDX-License-Identifier: Apache-2.0
// The parts of a fit that one state of a lens and a range of states have in common.
#pragma once

#include "contrejour/expert/polynomial.h"

namespace contrejour::inline internal::polynomial {

[[nodiscard]] Result<void> check_fit_options(const PolynomialOptions& options);
// The lens with its stop at its widest.
[[nodiscard]] LensState wide_open(const LensState& lens);
// The tangent of the largest angle of a light.
[[nodiscard]] double largest_field(const LensState& lens, const PolynomialOptions& options);
// All values of a fit but its ghosts.
[[nodiscard]] LensPolynomials without_ghosts(const LensState& lens, const PolynomialOptions& options);
// Errors: a ghost that the lens does not have.
[[nodiscard]] Result<std::vector<Ghost>> ghosts_to_fit(const LensState& lens, const PolynomialOptions& options);
inline constexpr double kBeyondCorner = 1.1;  // the largest field, of the tangent of the corner's angle
// The whole field as a zone that must be traced.
[[nodiscard]] PolynomialZone traced_zone(const LensPolynomials& all);
// False for ghosts without axial symmetry and those that pass an obscuration, which must be traced.
[[nodiscard]] bool is_fitted(const LensState& lens, const Ghost& ghost);

}  // namespace contrejour::inline internal::polynomial
