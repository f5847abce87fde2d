// SPDX-License-Identifier: Apache-2.0
// Comparison of numbers of any size. doctest::Approx adds 1 to the larger number before it multiplies with epsilon,
// so that a number of 0.01 equals any other within epsilon itself; here epsilon is relative. Thread-safety: pure.
#pragma once

#include <doctest/doctest.h>

namespace contrejour::test {

// Within 1e-5 of the number, or as .epsilon() says; 0 is compared as next to 1, or as .scale() says.
inline doctest::Approx approx(double number) { return doctest::Approx(number).scale(number == 0.0 ? 1.0 : 0.0); }

}  // namespace contrejour::test
