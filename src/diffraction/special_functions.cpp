// SPDX-License-Identifier: Apache-2.0
#include "diffraction/special_functions.h"

#include <cmath>
#include <numbers>

namespace contrejour::inline internal {
namespace {

// Si(x) for x >= 0.
double sine_integral(double x) {
  const double x2 = x * x;
  if (x < 4.0) {  // 5.2.14
    double term = x, sum = x;
    for (int n = 1; n < 14; ++n) {
      term *= -x2 / ((2.0 * n) * (2.0 * n + 1.0));
      sum += term / (2.0 * n + 1.0);
    }
    return sum;
  }
  // 5.2.38 and 5.2.39, |error| < 5e-7 and 3e-7 for x >= 1.
  const double f = ((((x2 + 38.027264) * x2 + 265.187033) * x2 + 335.677320) * x2 + 38.102495) /
                   (((((x2 + 40.021433) * x2 + 322.624911) * x2 + 570.236280) * x2 + 157.105423) * x);
  const double g = ((((x2 + 42.242855) * x2 + 302.757865) * x2 + 352.018498) * x2 + 21.821899) /
                   (((((x2 + 48.196927) * x2 + 482.485984) * x2 + 1114.978885) * x2 + 449.690326) * x2);
  return 0.5 * std::numbers::pi - f * std::cos(x) - g * std::sin(x);
}

}  // namespace

FresnelIntegrals fresnel_integrals(double x) {
  const double a = std::abs(x);
  const double f = (1.0 + 0.926 * a) / (2.0 + (1.792 + 3.104 * a) * a);
  const double g = 1.0 / (2.0 + (4.142 + (3.492 + 6.670 * a) * a) * a);
  const auto phase = static_cast<float>(0.5 * std::numbers::pi * a * a);  // faster, and accurate enough for f and g
  const double sine = std::sin(phase), cosine = std::cos(phase);
  return {std::copysign(0.5 + f * sine - g * cosine, x), std::copysign(0.5 - f * cosine - g * sine, x)};
}

double integral_of_sinc_squared(double x) {
  const double a = std::abs(x);
  if (a < 1e-4) return x;
  const double sine = std::sin(a);
  return std::copysign(sine_integral(2.0 * a) - sine * sine / a, x);
}

}  // namespace contrejour::inline internal
