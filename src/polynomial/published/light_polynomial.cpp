// SPDX-License-Identifier: Apache-2.0
#include "polynomial/published/light_polynomial.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::polynomial {

LightPolynomial::LightPolynomial(const published::Polynomial& polynomial, Vec2 light) {
  for (const published::Term& term : polynomial.terms) {
    const auto& e = term.exponents;
    coefficients_[e[2]][e[3]] += term.coefficient * std::pow(light.x, e[0]) * std::pow(light.y, e[1]);
    degree_ = std::max<std::size_t>({degree_, e[2], e[3]});
  }
}

double LightPolynomial::at(Vec2 point) const {
  double value = 0.0;
  for (std::size_t i = degree_ + 1; i-- > 0;) {
    double row = 0.0;
    for (std::size_t j = degree_ - i + 1; j-- > 0;) row = row * point.y + coefficients_[i][j];
    value = value * point.x + row;
  }
  return value;
}

}  // namespace contrejour::inline internal::polynomial
