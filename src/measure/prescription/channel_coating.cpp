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
constexpr double kFilmIndex = 1.45;  // of the films, by which their phase falls with the angle of incidence
constexpr double kMostPhase = 0.4;   // off that of 550 nm, beyond which the parabola is not continued
constexpr std::array<double, 11> kAngles_deg{0, 10, 20, 30, 40, 50, 60, 70, 80, 85, 90};
constexpr double kLeast = 1e-5, kMost = 0.9;  // reflectances of a table
constexpr double kDigits = 1e7;               // a table's numbers are whole multiples of 1 / kDigits

// Reflectance as a parabola of the phase that light takes up in a film: coatings of few films have one minimum in the
// visible. At an angle of incidence the phase is smaller, as at a longer wavelength.
Eigen::Vector3d powers(double lambda_nm, double sine = 0.0) {
  const double cosine_in_film = std::sqrt(1.0 - sine * sine / (kFilmIndex * kFilmIndex));
  const double inside_nm = std::clamp(lambda_nm, kTable_nm.front(), kTable_nm.back());
  const double phase = std::clamp(550.0 * cosine_in_film / inside_nm - 1.0, -kMostPhase, kMostPhase);
  return {1.0, phase, phase * phase};
}

double bare_reflectance(const SurfaceState& surface, double cos_in, double lambda_nm) {
  const double before = refractive_index(surface.before, lambda_nm), after = refractive_index(surface.after, lambda_nm);
  return reflectance({}, std::min(before, after), std::max(before, after), cos_in, lambda_nm);
}

}  // namespace

Rgb channel_reflectance(const SurfaceState& surface, std::span<const SpectralBand> bands) {
  Rgb mean{};
  for (const SpectralBand& band : bands) {
    const double of = reflectance(surface.coating, refractive_index(surface.before, band.lambda_nm),
                                  refractive_index(surface.after, band.lambda_nm), 1.0, band.lambda_nm);
    for (std::size_t c = 0; c < 3; ++c) mean[c] += band.weight[c] * of;
  }
  return mean;
}

Coating channel_coating(const SurfaceState& surface, const Rgb& reflectance_of, std::span<const SpectralBand> bands) {
  Eigen::Matrix3d means = Eigen::Matrix3d::Zero();
  for (const SpectralBand& band : bands) {
    const Eigen::Vector3d of = powers(band.lambda_nm);
    for (std::size_t c = 0; c < 3; ++c) means.row(static_cast<Eigen::Index>(c)) += band.weight[c] * of.transpose();
  }
  const Eigen::Vector3d parabola =
      means.partialPivLu().solve(Eigen::Vector3d{reflectance_of[0], reflectance_of[1], reflectance_of[2]});
  MeasuredCoating table;
  table.lambda_nm.assign(kTable_nm.begin(), kTable_nm.end());
  table.angle_deg.assign(kAngles_deg.begin(), kAngles_deg.end());
  for (const double lambda_nm : kTable_nm) {
    const double bare = bare_reflectance(surface, 1.0, lambda_nm);
    for (const double angle : kAngles_deg) {
      const double films = std::clamp(parabola.dot(powers(lambda_nm, std::sin(rad_from_deg(angle)))), kLeast, kMost);
      // The bare glass's rise; both reflect everything at grazing incidence.
      const double rise = bare_reflectance(surface, std::cos(rad_from_deg(angle)), lambda_nm) - bare;
      const double value = angle >= 90.0 ? 1.0 : films + rise * (1.0 - films) / (1.0 - bare);
      table.reflectance.push_back(std::round(kDigits * std::clamp(value, 0.0, 1.0)) / kDigits);
    }
  }
  return {"", table};
}

}  // namespace contrejour::inline internal
