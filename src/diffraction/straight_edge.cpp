// SPDX-License-Identifier: Apache-2.0
#include "diffraction/straight_edge.h"

#include <cmath>
#include <numbers>

#include "base/scalar.h"

namespace contrejour::inline internal {
namespace {

using Complex = std::complex<double>;
constexpr int kBandSamples = 9;

// exp(-i pi / 4) times the integral of exp(i pi t^2) from -infinity to each step, at one wavelength.
std::vector<Complex> edge_by_steps(double first, double step, std::size_t count) {
  const auto phasor = [](double t) { return std::polar(1.0, kPi * (t * t - 0.25)); };
  // From -infinity: by parts, exp(i pi t^2) / (2 pi i t) (1 + 1 / (2 pi i t^2) + 3 / (2 pi i t^2)^2).
  const Complex q = 1.0 / Complex(0.0, 2.0 * kPi * first * first);
  Complex sum = phasor(first) / Complex(0.0, 2.0 * kPi * first) * (1.0 + q + 3.0 * q * q);
  std::vector<Complex> out{sum};
  for (std::size_t k = 1; k < count; ++k) {
    const double a = first + static_cast<double>(k - 1) * step;
    sum += step / 6.0 * (phasor(a) + 4.0 * phasor(a + 0.5 * step) + phasor(a + step));
    out.push_back(sum);
  }
  return out;
}

}  // namespace

// Lengths are in units of the square root of the wavelength: for short wavelengths the same distance is longer.
StraightEdge::StraightEdge(double spread) {
  const double half_band = std::min(std::numbers::sqrt3 * spread, 0.9);  // of a uniform band of that spread
  const int samples = half_band > 0.0 ? kBandSamples : 1;
  constexpr double kFine = 0.25 / kSteps, kFar = 4.0 * kReach;
  const auto fine = edge_by_steps(-kFar, kFine, static_cast<std::size_t>(2.0 * kFar / kFine) + 2);
  const auto one_wavelength = [&](double t) {
    const double position = std::clamp((t + kFar) / kFine, 0.0, 2.0 * kFar / kFine);
    const auto k = static_cast<std::size_t>(position);
    return fine[k] + (fine[k + 1] - fine[k]) * (position - static_cast<double>(k));
  };
  const auto count = static_cast<std::size_t>(2.0 * kReach * kSteps) + 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / kSteps - kReach;
    Complex mean = 0.0;
    for (int j = 0; j < samples; ++j) {
      const double lambda = 1.0 + half_band * ((2.0 * j + 1.0) / samples - 1.0);
      mean += one_wavelength(t / std::sqrt(lambda)) / static_cast<double>(samples);
    }
    const double level = t > 0.0 ? 1.0 : 0.0;
    const double kept = 1.0 - smooth_step((std::abs(t) - kTaperFrom) / (kReach - kTaperFrom));
    value_.emplace_back(level + (mean - level) * kept);
  }
  for (std::size_t k = 0; k + 1 < count; ++k) change_.push_back(value_[k + 1] - value_[k]);
  change_.emplace_back(0.0F);
}

}  // namespace contrejour::inline internal
