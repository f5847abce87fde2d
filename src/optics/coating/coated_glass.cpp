// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/coated_glass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contrejour/expert/film_design.h"

namespace contrejour {
namespace {

Result<void> check_wavelengths(std::span<const double> lambda_nm) {
  const auto is_good = [](double nm) { return nm >= 1.0 && nm <= 1e6; };
  if (std::ranges::all_of(lambda_nm, is_good)) return {};
  return invalid_argument("a wavelength is out of range; give nm, as 550");
}

// Writes power(coating, n_glass, cos, lambda) for each pair of wavelength and angle.
template <class Power>
Result<std::vector<double>> powers(const Coating& coating, const Glass& glass, std::span<const double> lambda_nm,
                                   std::span<const double> angle_rad, const Power& power) {
  if (lambda_nm.size() != angle_rad.size())
    return invalid_argument("there are more wavelengths than angles, or fewer; give one angle for each wavelength");
  if (auto good = check_wavelengths(lambda_nm); !good) return tl::unexpected(good.error());
  const auto is_angle = [](double rad) { return rad >= 0.0 && rad <= 0.5 * std::numbers::pi; };
  if (!std::ranges::all_of(angle_rad, is_angle))
    return invalid_argument("an angle of incidence is out of range; give 0 to 90 degrees");
  const Coating placed = placed_on(coating, air(), glass);
  std::vector<double> values;
  values.reserve(lambda_nm.size());
  for (std::size_t k = 0; k < lambda_nm.size(); ++k)
    values.push_back(power(placed, 1.0, refractive_index(glass, lambda_nm[k]), std::cos(angle_rad[k]), lambda_nm[k]));
  return values;
}

}  // namespace

Result<std::vector<double>> coated_reflectances(const Coating& coating, const Glass& glass,
                                                std::span<const double> lambda_nm, std::span<const double> angle_rad) {
  return powers(coating, glass, lambda_nm, angle_rad, reflectance);
}

Result<std::vector<double>> coated_transmittances(const Coating& coating, const Glass& glass,
                                                  std::span<const double> lambda_nm,
                                                  std::span<const double> angle_rad) {
  return powers(coating, glass, lambda_nm, angle_rad, transmittance);
}

Result<FilmStack> films_on(const Coating& coating, const Glass& glass) {
  const Coating placed = placed_on(coating, air(), glass);
  if (const auto* stack = std::get_if<FilmStack>(&placed.films)) return *stack;
  if (const auto* film = std::get_if<QuarterWave>(&placed.films))
    return FilmStack{{{FilmMaterial(film->n), film->lambda0_nm / (4.0 * film->n)}}};
  return invalid_argument("\"" + describe(coating) +
                          "\" has no films; give a design, as v-coat, a quarter wave, or a stack");
}

Result<FilmStack> refined_to_targets(const Coating& start, const Glass& glass, std::span<const double> lambda_nm,
                                     std::span<const double> target, std::span<const double> weight) {
  if (lambda_nm.empty() || lambda_nm.size() != target.size() || (!weight.empty() && weight.size() != target.size()))
    return invalid_argument("give one target, and one weight if any, for each wavelength, and at least one wavelength");
  if (auto good = check_wavelengths(lambda_nm); !good) return tl::unexpected(good.error());
  if (!std::ranges::all_of(target, [](double r) { return r >= 0.0 && r <= 1.0; }))
    return invalid_argument("a target is out of range; give reflectances from 0 to 1");
  if (!std::ranges::all_of(weight, [](double w) { return w >= 0.0 && std::isfinite(w); }))
    return invalid_argument("a weight is out of range; give 0 or more");
  const auto films = films_on(start, glass);
  if (!films) return films;
  FilmGoal goal;
  goal.lambda_nm.assign(lambda_nm.begin(), lambda_nm.end());
  goal.off = [&](std::span<const double> r) {
    std::vector<double> off(r.size());
    for (std::size_t k = 0; k < r.size(); ++k) off[k] = (weight.empty() ? 1.0 : weight[k]) * (r[k] - target[k]);
    return off;
  };
  return refined(*films, glass, goal);
}

}  // namespace contrejour
