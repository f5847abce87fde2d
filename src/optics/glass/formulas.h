// SPDX-License-Identifier: Apache-2.0
// The catalogues' dispersion formulas (docs/physics/glass.md has each with its source).
#pragma once

#include <cstddef>
#include <span>

#include "contrejour/expert/glass.h"

namespace contrejour::inline internal {

// n of a formula; NaN where n^2 is negative. Coefficients that are missing at the end count as 0.
[[nodiscard]] double formula_index(DispersionFormula formula, std::span<const double> coefficients, double lambda_um);

// How many coefficients a formula takes.
struct CoefficientCount {
  std::size_t min = 0, max = 0;
  bool odd = false, even = false;  // required parity of the count
};
[[nodiscard]] CoefficientCount coefficient_count(DispersionFormula formula);

// Between the points of a table (wavelength, value, wavelength, value, ...): piecewise cubic, monotone where the data
// are, without overshoot (Fritsch & Butland 1984); the end values beyond. At least one point.
[[nodiscard]] double table_value(std::span<const double> points, double x);

}  // namespace contrejour::inline internal
