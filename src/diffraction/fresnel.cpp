// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/fresnel.h"

#include <cmath>
#include <complex>
#include <span>

#include "base/scalar.h"
#include "base/units.h"
#include "diffraction/chirp_z.h"
#include "diffraction/complex_product.h"
#include "diffraction/fft.h"
#include "diffraction/fresnel_methods.h"

namespace contrejour::inline internal {
namespace {

using Wave = std::vector<std::complex<double>>;

constexpr double kSamplesPerFresnel =
    16.0;  // across the stop, for each unit of F: a turn of the chirp has 8 at the rim
constexpr double kTaper = 0.8;               // of the band limit, from which on the spectrum is faded out

std::size_t samples_of_square(std::size_t side) { return side * side; }

double fade(double f, double limit) {
  const double t = (std::abs(f) / limit - kTaper) / (1.0 - kTaper);
  if (!(t > 0.0)) return 1.0;
  return t >= 1.0 ? 0.0 : 0.5 + 0.5 * std::cos(kPi * t);
}

RegularPoints pattern_points(int side, double extent) {
  return centred_points(static_cast<std::size_t>(side), 2.0 * extent / side);
}

std::vector<double> intensities(const Wave& wave, double scale) {
  std::vector<double> result(wave.size());
  for (std::size_t k = 0; k < wave.size(); ++k) result[k] = scale * std::norm(wave[k]);
  return result;
}

// The mask in the middle of a square of zeros.
Wave padded_wave(const PupilMask& mask, std::size_t padded) {
  const auto side = static_cast<std::size_t>(mask.grid.side);
  const std::size_t first = (padded - side) / 2;
  Wave wave(samples_of_square(padded));
  for (std::size_t r = 0; r < side; ++r)
    for (std::size_t c = 0; c < side; ++c) wave[(first + r) * padded + first + c] = mask.at(r * side + c);
  return wave;
}

}  // namespace

// Goodman 2005 eq. 4-21: H(f) = exp(-i pi f^2 / F), f in cycles per stop radius. A frequency moves light by f / F.
std::vector<double> fresnel_near(const PupilMask& mask, double stop_radius_mm, double fresnel_number, int side,
                                 double extent, const Context& context) {
  const double pitch = mask.grid.pitch_mm / stop_radius_mm, half_mask = 0.5 * mask.grid.side * pitch;
  const double half_window = std::max(2.0 * half_mask, half_mask + extent);
  const std::size_t padded =
      good_fft_size(static_cast<std::size_t>(2.0 * half_window / pitch) + static_cast<std::size_t>(mask.grid.side % 2));
  Wave wave = padded_wave(mask, padded);
  if (!fft_2d<double>(wave, {padded, padded}, FftDirection::Forward, context)) return {};

  // Matsushima & Shimobaba 2009: a smooth band limit removes what would alias into the pattern from beyond the window.
  const double step = 1.0 / (static_cast<double>(padded) * pitch);
  const double limit = fresnel_number * (static_cast<double>(padded) * pitch - half_mask - extent);
  std::vector<std::complex<double>> transfer(padded);
  const std::size_t half = padded / 2;
  for (std::size_t k = 0; k < padded; ++k) {
    const double f = (static_cast<double>(k) - static_cast<double>(half)) * step;
    // The mask's first sample is not at the window's corner but `first` samples in, and half a sample off the middle.
    const double start = -0.5 * static_cast<double>(mask.grid.side - 1) * pitch -
                         static_cast<double>((padded - static_cast<std::size_t>(mask.grid.side)) / 2) * pitch;
    transfer[k] = fade(f, limit) * std::polar(1.0, -kPi * f * f / fresnel_number - 2.0 * kPi * f * start);
  }
  Wave spectrum(wave.size());
  for (std::size_t r = 0; r < padded; ++r) {
    const std::complex<double>* const from = &wave[(r + padded - half) % padded * padded];
    std::complex<double>* const to = &spectrum[r * padded];
    const auto move = [&](std::size_t c, std::size_t at) {
      to[c] = product(from[at], product(transfer[r], transfer[c]));
    };
    for (std::size_t c = 0; c < half; ++c) move(c, c + padded - half);
    for (std::size_t c = half; c < padded; ++c) move(c, c - half);
  }

  // Back to the pattern's points: exp(+2 pi i f x) is the chirp transform to -x.
  const RegularPoints points = pattern_points(side, extent);
  const ChirpZ back({padded, -static_cast<double>(half) * step, step}, {points.count, -points.first, -points.step});
  const Wave pattern = back.transform_2d(spectrum, context);
  return intensities(pattern, 1.0 / samples_of_square(padded) / square(padded));
}

// Goodman 2005 eq. 4-17 in stop radii: U(x) = F integral of U(s) exp(i pi F s^2) exp(-2 pi i F x.s) d^2 s.
std::vector<double> fresnel_far(const PupilMask& mask, double stop_radius_mm, double fresnel_number, int side,
                                double extent, const Context& context) {
  const double pitch = mask.grid.pitch_mm / stop_radius_mm;
  const auto samples = static_cast<std::size_t>(mask.grid.side);
  const RegularPoints from = centred_points(samples, pitch), points = pattern_points(side, extent);
  std::vector<std::complex<double>> chirp(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const double s = from.first + static_cast<double>(k) * from.step;
    chirp[k] = std::polar(1.0, kPi * fresnel_number * s * s);
  }
  Wave wave(samples_of_square(samples));
  for (std::size_t r = 0; r < samples; ++r)
    for (std::size_t c = 0; c < samples; ++c)
      wave[r * samples + c] = product(product(mask.at(r * samples + c), chirp[r]), chirp[c]);
  const ChirpZ transform(from, {points.count, fresnel_number * points.first, fresnel_number * points.step});
  const double amplitude = fresnel_number * pitch * pitch;
  return intensities(transform.transform_2d(wave, context), amplitude * amplitude);
}

double far_up_to(const PupilMask& mask, double stop_radius_mm) {
  return 2.0 * stop_radius_mm / mask.grid.pitch_mm / kSamplesPerFresnel;
}

}  // namespace contrejour::inline internal

namespace contrejour {

double fresnel_extent(double fresnel_number) { return 1.0 + 2.0 / std::sqrt(fresnel_number) + 4.0 / fresnel_number; }

namespace {

// True if the pattern fits into memory: kMaxPadded samples a side.
bool is_usable(const PupilMask& mask, double stop_radius_mm, const FresnelSettings& settings) {
  constexpr double kMaxPadded = 32768.0;
  if (!mask.is_complete() || !(stop_radius_mm > 0.0) || !(settings.fresnel_number > 0.0) || settings.side < 1 ||
      settings.side > MaskGrid::kMaxSamples)
    return false;
  const double extent = settings.extent > 0.0 ? settings.extent : fresnel_extent(settings.fresnel_number);
  const double pitch = mask.grid.pitch_mm / stop_radius_mm;
  if (!std::isfinite(extent) || !(pitch > 0.0) || !std::isfinite(mask.grid.side * pitch)) return false;
  return settings.fresnel_number <= far_up_to(mask, stop_radius_mm) ||
         mask.grid.side + 2.0 * extent / pitch <= kMaxPadded;
}

}  // namespace

FresnelPattern fresnel_pattern(const PupilMask& mask, double stop_radius_mm, const FresnelSettings& settings,
                               const Context& context) {
  if (!is_usable(mask, stop_radius_mm, settings)) return {};
  Context steps = context;
  steps.progress = {};
  const double f = settings.fresnel_number;
  FresnelPattern pattern{settings.side, settings.extent > 0.0 ? settings.extent : fresnel_extent(f), {}, 0.0};
  const auto method = f <= far_up_to(mask, stop_radius_mm) ? fresnel_far : fresnel_near;
  pattern.irradiance = method(mask, stop_radius_mm, f, pattern.side, pattern.extent, steps);
  if (context.cancelled()) pattern.irradiance.clear();
  double sum = 0.0;
  for (const double e : pattern.irradiance) sum += e;
  const double pitch_mm = 2.0 * pattern.extent / pattern.side * stop_radius_mm;
  pattern.flux = sum * pitch_mm * pitch_mm / mask.open_area_mm2();
  return pattern;
}

double fresnel_number(double stop_radius_mm, double a, double b_mm, double lambda_nm) {
  return std::abs(a * stop_radius_mm * stop_radius_mm / (mm_from_nm(lambda_nm) * b_mm));
}

}  // namespace contrejour
