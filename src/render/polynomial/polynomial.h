// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contrejour/expert/polynomial_method.h"
#include "render/planning/method.h"

namespace contrejour::inline internal {

// Ghosts fitted once for the whole field, drawn with the machinery of `adaptive` (docs/physics/polynomial.md).
// Errors: in addition to those of `adaptive`, those of the fit and of its file, and a fit of another lens.
[[nodiscard]] Result<DrawnFlare> render_polynomial(const PlannedFrame& planned, const PolynomialRenderOptions& options,
                                                   const Context& context);

inline constexpr Method kPolynomial = method_of<PolynomialRenderOptions, render_polynomial>({.spends_error = true});

}  // namespace contrejour::inline internal
