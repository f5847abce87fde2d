// SPDX-License-Identifier: Apache-2.0
// A polynomial in four variables for one light, the first two: what is left is one in the other two, evaluated by
// Horner's rule.
#pragma once

#include <array>

#include "contrejour/expert/published_fits.h"
#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::polynomial {

class LightPolynomial {
 public:
  // polynomial: of monomials.
  LightPolynomial(const published::Polynomial& polynomial, Vec2 light);

  [[nodiscard]] double at(Vec2 point) const;

 private:
  static constexpr std::size_t kSide = published::kLargestDegree + 1;
  std::array<std::array<double, kSide>, kSide> coefficients_{};
  std::size_t degree_ = 0;
};

}  // namespace contrejour::inline internal::polynomial
