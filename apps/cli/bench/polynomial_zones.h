// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/bench/polynomial_fits.h"

namespace contrejour::cli {

// Adds the table "zones": sparse polynomials with few terms in zones of the field, and our whole-field fit of the same
// ghosts. Errors are in pixels of the sensor's width / 1920.
[[nodiscard]] Result<void> measure_polynomial_zones(PolynomialFits& fits, const PolynomialBenchOptions& options,
                                                    const Context& context);

}  // namespace contrejour::cli
