// SPDX-License-Identifier: Apache-2.0
// The product of two finite complex numbers. std::complex checks every result for infinities, which takes longer than
// the product.
#pragma once

#include <complex>

namespace contrejour::inline internal {

template <class Real>
[[nodiscard]] inline std::complex<Real> product(const std::complex<Real>& a, const std::complex<Real>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace contrejour::inline internal
