// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/channel_coating.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "base/units.h"

namespace contrejour::inline internal {
namespace {

// Near the means of the channels' wavelengths; in the order of wavelengths, which is the reverse of red, green, blue.
constexpr std::array<double, 3> kNodes_nm{455.0, 545.0, 610.0};
constexpr std::array<double, 11> kAngles_deg{0, 10, 20, 30, 40, 50, 60, 70, 80, 85, 90};
constexpr double kLeast = 1e-5, kMost = 0.9;  // reflectances of a table
constexpr double kDigits = 1e7;               // a table's numbers are whole multiples of 1 / kDigits

// Weights of linear interpolation between the nodes, constant beyond them.
Eigen::Vector3d node_weights(double lambda_nm) {
  if (lambda_nm <= kNodes_nm.front()) return {1.0, 0.0, 0.0};
  if (lambda_nm >= kNodes_nm.back()) return {0.0, 0.0, 1.0};
  const int low = lambda_nm < kNodes_nm[1] ? 0 : 1;
  const double from = kNodes_nm[static_cast<std::size_t>(low)], to = kNodes_nm[static_cast<std::size_t>(low + 1)];
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  weights[low + 1] = (lambda_nm - from) / (to - from);
  weights[low] = 1.0 - weights[low + 1];
  return weights;
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
    const Eigen::Vector3d weights = node_weights(band.lambda_nm);
    for (std::size_t c = 0; c < 3; ++c) means.row(static_cast<Eigen::Index>(c)) += band.weight[c] * weights.transpose();
  }
  const Eigen::Vector3d at_nodes =
      means.partialPivLu().solve(Eigen::Vector3d{reflectance_of[0], reflectance_of[1], reflectance_of[2]});
  MeasuredCoating table;
  table.lambda_nm.assign(kNodes_nm.begin(), kNodes_nm.end());
  table.angle_deg.assign(kAngles_deg.begin(), kAngles_deg.end());
  for (std::size_t n = 0; n < kNodes_nm.size(); ++n) {
    const double normal = std::clamp(at_nodes[static_cast<Eigen::Index>(n)], kLeast, kMost);
    const double bare = bare_reflectance(surface, 1.0, kNodes_nm[n]);
    for (const double angle : kAngles_deg) {
      // The bare glass's rise; both reflect everything at grazing incidence.
      const double rise = bare_reflectance(surface, std::cos(rad_from_deg(angle)), kNodes_nm[n]) - bare;
      const double value = angle >= 90.0 ? 1.0 : normal + rise * (1.0 - normal) / (1.0 - bare);
      table.reflectance.push_back(std::round(kDigits * std::clamp(value, 0.0, 1.0)) / kDigits);
    }
  }
  return {"", table};
}

}  // namespace contrejour::inline internal
