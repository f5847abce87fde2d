// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/channel_coating.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "base/units.h"

namespace contrejour::inline internal {
namespace {

// A table's wavelengths. Between and beyond them the channels of a light have little weight.
constexpr std::array<double, 11> kTable_nm{400, 430, 460, 490, 520, 550, 580, 610, 640, 670, 700};
constexpr double kFilmIndex = 1.45;  // of films, by which their phase falls with the angle of incidence
constexpr double kMostPhase = 0.4;   // off that of 550 nm, beyond which the parabola is not continued
constexpr std::array<double, 11> kAngles_deg{0, 10, 20, 30, 40, 50, 60, 70, 80, 85, 90};
constexpr double kLeast = 1e-5;  // reflectance of a table
constexpr double kDigits = 1e7;               // a table's numbers are whole multiples of 1 / kDigits

// The single films that are tried.
constexpr int kFilmIndices = 40, kFilmThicknesses = 64;
constexpr double kLeastFilmIndex = 1.2, kFilmIndexStep = 0.02;
constexpr double kThinnest_nm = 360.0, kThicknessStep_nm = 10.0;  // four times index and width

// Powers of the phase that light takes up in a film. At an angle of incidence the phase is smaller, as at a longer
// wavelength.
Eigen::Vector3d powers(double lambda_nm, double sine = 0.0) {
  const double cosine_in_film = std::sqrt(1.0 - sine * sine / (kFilmIndex * kFilmIndex));
  const double inside_nm = std::clamp(lambda_nm, kTable_nm.front(), kTable_nm.back());
  const double phase = std::clamp(550.0 * cosine_in_film / inside_nm - 1.0, -kMostPhase, kMostPhase);
  return {1.0, phase, phase * phase};
}

// The reflectance of a coating on a surface for light that comes from the side of lower index.
double reflectance_of(const Coating& coating, const SurfaceState& surface, double cos_in, double lambda_nm) {
  const double before = refractive_index(surface.before, lambda_nm), after = refractive_index(surface.after, lambda_nm);
  return reflectance(coating, std::min(before, after), std::max(before, after), cos_in, lambda_nm);
}

Rgb channel_means(const Coating& coating, const SurfaceState& surface, std::span<const SpectralBand> bands) {
  Rgb mean{};
  for (const SpectralBand& band : bands) {
    const double of = reflectance_of(coating, surface, 1.0, band.lambda_nm);
    for (std::size_t c = 0; c < 3; ++c) mean[c] += band.weight[c] * of;
  }
  return mean;
}

// The single film, or none, whose reflectances in the channels are nearest to these.
Coating nearest_film(const SurfaceState& surface, const Rgb& wanted, std::span<const SpectralBand> bands) {
  const auto misfit = [&](const Coating& coating) {
    const Rgb means = channel_means(coating, surface, bands);
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += std::pow(means[c] / std::max(wanted[c], kLeast) - 1.0, 2);
    return sum;
  };
  Coating nearest;
  double least = misfit(nearest);
  for (int n = 0; n < kFilmIndices; ++n) {
    for (int k = 0; k < kFilmThicknesses; ++k) {
      const Coating film{"", QuarterWave{kLeastFilmIndex + kFilmIndexStep * n, kThinnest_nm + kThicknessStep_nm * k}};
      const double of = misfit(film);
      if (!(of < least)) continue;
      least = of;
      nearest = film;
    }
  }
  return nearest;
}

}  // namespace

Rgb channel_reflectance(const SurfaceState& surface, std::span<const SpectralBand> bands) {
  return channel_means(surface.coating, surface, bands);
}

Coating channel_coating(const SurfaceState& surface, const Rgb& wanted, std::span<const SpectralBand> bands) {
  const Coating film = nearest_film(surface, wanted, bands);
  const Rgb of_film = channel_means(film, surface, bands);
  Eigen::Matrix3d means = Eigen::Matrix3d::Zero();
  for (const SpectralBand& band : bands) {
    const Eigen::Vector3d of = powers(band.lambda_nm);
    for (std::size_t c = 0; c < 3; ++c) means.row(static_cast<Eigen::Index>(c)) += band.weight[c] * of.transpose();
  }
  const Eigen::Vector3d left = means.partialPivLu().solve(
      Eigen::Vector3d{wanted[0] - of_film[0], wanted[1] - of_film[1], wanted[2] - of_film[2]});
  MeasuredCoating table;
  table.lambda_nm.assign(kTable_nm.begin(), kTable_nm.end());
  table.angle_deg.assign(kAngles_deg.begin(), kAngles_deg.end());
  for (const double lambda_nm : kTable_nm) {
    for (const double angle : kAngles_deg) {
      const double sine = std::sin(rad_from_deg(angle)), cosine = std::cos(rad_from_deg(angle));
      const double value = reflectance_of(film, surface, cosine, lambda_nm) + left.dot(powers(lambda_nm, sine));
      const double kept = angle >= 90.0 ? 1.0 : std::clamp(value, kLeast, 1.0);
      table.reflectance.push_back(std::round(kDigits * kept) / kDigits);
    }
  }
  return {"", table};
}

}  // namespace contrejour::inline internal
