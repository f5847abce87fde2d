// SPDX-License-Identifier: Apache-2.0
// Fitted ghosts in Python's hands.
#pragma once

#include <memory>

#include "contrejour/expert/polynomial_range.h"

namespace contrejour::python {

// A fit of one state of a lens, or of a range: one of the two pointers is set.
struct AnyFit {
  std::shared_ptr<const LensPolynomials> state;
  std::shared_ptr<const LensPolynomialRange> range;
};

}  // namespace contrejour::python
