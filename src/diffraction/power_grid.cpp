// SPDX-License-Identifier: Apache-2.0
#include "diffraction/power_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/tasks.h"
#include "diffraction/fft.h"

namespace contrejour::inline internal {
namespace {

// Power has twice the mask's bandwidth: padding by 2 just represents it, 4 allows cubic interpolation between samples.
constexpr std::size_t kPadding = 4;
constexpr double kResolved = 0.45;  // of the sampling frequency; beyond, aliases are as strong as the spectrum
constexpr int kMargin = 2;          // samples that a cubic reads beyond its position

double sinc(double x) {
  const double t = std::numbers::pi * x;
  return std::abs(t) < 1e-8 ? 1.0 : std::sin(t) / t;
}

// Catmull & Rom 1974: cubic through the middle two of four samples.
std::array<float, 4> cubic_weights(float t) {
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F, ((-1.5F * t + 2.0F) * t + 0.5F) * t,
          (0.5F * t - 0.5F) * t * t};
}

}  // namespace

PowerGrid::PowerGrid(const PupilMask& mask, double pupil_radius_mm, double up_to, double power_mm2, bool edges,
                     const Context& context) {
  const auto side = static_cast<std::size_t>(mask.grid.side);
  const std::size_t padded = good_fft_size(kPadding * side);
  const double across = 2.0 * pupil_radius_mm / mask.grid.pitch_mm;  // samples; also rho at the sampling frequency
  step_ = across / static_cast<double>(padded);
  up_to_ = std::min(up_to, kResolved * across);
  half_ = static_cast<int>(std::ceil(up_to_ / step_)) + kMargin;
  width_ = static_cast<std::size_t>(half_ + kMargin + 1);
  density_.resize(static_cast<std::size_t>(2 * half_ + 1) * width_);

  // |sum|^2 summed over the padded^2 frequencies is padded^2 times the samples' own power (Parseval).
  const double scale = mask.grid.pitch_mm * mask.grid.pitch_mm / (power_mm2 * across * across);
  std::vector<float> correction(static_cast<std::size_t>(half_ + 1), 1.0F);
  for (std::size_t i = 0; edges && i < correction.size(); ++i)
    correction[i] = static_cast<float>(std::pow(sinc(static_cast<double>(i) * step_ / across), -2.0));

  const std::size_t columns = std::min(padded / 2 + 1, static_cast<std::size_t>(half_ + 1));
  const std::vector<std::complex<float>> spectrum = fft_2d_real(mask.amplitude, {side, side}, padded, columns, context);
  parallel_for(static_cast<std::size_t>(2 * half_ + 1), context, [&](std::size_t r) {
    const int y = static_cast<int>(r) - half_;
    for (int x = -kMargin; x <= half_; ++x) {
      // A real mask's power at -f equals that at f. Rows of the mask go down, y goes up.
      const auto column = static_cast<std::size_t>(std::abs(x));
      const int signed_row = x < 0 ? y : -y;
      const std::size_t row =
          signed_row < 0 ? padded - static_cast<std::size_t>(-signed_row) : static_cast<std::size_t>(signed_row);
      const float norm = std::norm(spectrum[row * columns + column]);
      density_[r * width_ + static_cast<std::size_t>(x + kMargin)] =
          static_cast<float>(norm * scale) * correction[column] * correction[static_cast<std::size_t>(std::abs(y))];
    }
  });
}

double PowerGrid::density(double rho_x, double rho_y) const {
  const double x = rho_x / step_ + kMargin, y = rho_y / step_ + half_;
  const auto column = static_cast<int>(x), row = static_cast<int>(y);
  const std::array<float, 4> wx = cubic_weights(static_cast<float>(x - column));
  const std::array<float, 4> wy = cubic_weights(static_cast<float>(y - row));
  const float* p = density_.data() + static_cast<std::size_t>(row - 1) * width_ + static_cast<std::size_t>(column - 1);
  float sum = 0.0F;
  for (std::size_t j = 0; j < 4; ++j, p += width_)
    sum += wy[j] * (wx[0] * p[0] + wx[1] * p[1] + wx[2] * p[2] + wx[3] * p[3]);
  return std::max(sum, 0.0F);  // a cubic may overshoot below 0 between the fringes
}

}  // namespace contrejour::inline internal
