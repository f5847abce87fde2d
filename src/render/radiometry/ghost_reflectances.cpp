// SPDX-License-Identifier: Apache-2.0
#include "render/radiometry/ghost_reflectances.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "contrejour/expert/coating.h"

namespace contrejour::inline internal {
namespace {

// Cosines of the angle in the medium of lower index: a ray at one such angle meets both sides of a lens in the same
// way.
constexpr std::array kCosines{0.85, 0.8875, 0.925, 0.9625, 1.0};

double mean_reflectance(const SurfaceState& surface, double lambda_nm) {
  const double before = refractive_index(surface.before, lambda_nm);
  const double after = refractive_index(surface.after, lambda_nm);
  const Coating coating = at_wavelength(surface.coating, lambda_nm);
  double sum = 0.0;
  for (const double u : kCosines) {
    const double eta = after / before;
    const double cos_in = eta < 1.0 ? std::sqrt(1.0 - eta * eta * (1.0 - u * u)) : u;
    sum += reflectance(coating, before, after, cos_in, lambda_nm);
  }
  return sum / kCosines.size();
}

// Surfaces with the same reflectance are computed once.
std::vector<double> mean_reflectances(const LensState& lens, double lambda_nm) {
  std::vector<double> all;
  for (const SurfaceState& surface : lens.surfaces) {
    const auto alike = [&](const SurfaceState& other) {
      return other.kind == surface.kind && other.coating == surface.coating && other.before == surface.before &&
             other.after == surface.after;
    };
    std::size_t same = 0;
    while (same < all.size() && !alike(lens.surfaces[same])) ++same;
    const bool is_stop = surface.kind == SurfaceKind::Stop;
    all.push_back(same < all.size() ? all[same] : is_stop ? 1.0 : mean_reflectance(surface, lambda_nm));
  }
  return all;
}

}  // namespace

void GhostReflectances::add(const LensState& lens, std::span<const double> lambda_nm) {
  for (const double nm : lambda_nm) {
    if (!by_wavelength_.contains(nm)) by_wavelength_.emplace(nm, mean_reflectances(lens, nm));
  }
}

double GhostReflectances::of(const Ghost& ghost, double lambda_nm) const {
  const std::vector<double>& at = by_wavelength_.at(lambda_nm);
  double product = 1.0;
  for (const int surface : {ghost.i, ghost.j, ghost.k, ghost.l})
    if (surface > 0 && static_cast<std::size_t>(surface) <= at.size())
      product *= at[static_cast<std::size_t>(surface - 1)];
  return product;
}

}  // namespace contrejour::inline internal
