// SPDX-License-Identifier: Apache-2.0
// Integrals of diffraction at an edge.
#pragma once

namespace contrejour::inline internal {

struct FresnelIntegrals {
  double c = 0, s = 0;  // of cos and sin of pi t^2 / 2 from 0 to x
};

// To 2e-3. Source: Abramowitz & Stegun 7.3.9, 7.3.10 with the rational approximations 7.3.32, 7.3.33.
[[nodiscard]] FresnelIntegrals fresnel_integrals(double x);

// Integral of (sin t / t)^2 from 0 to x. To 1e-5. Source: Si(2x) - sin(x)^2 / x, Si from Abramowitz & Stegun 5.2.14,
// 5.2.8 with 5.2.38, 5.2.39.
[[nodiscard]] double integral_of_sinc_squared(double x);

}  // namespace contrejour::inline internal
