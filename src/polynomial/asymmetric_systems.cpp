// SPDX-License-Identifier: Apache-2.0
#include "polynomial/asymmetric_systems.h"

#include <algorithm>
#include <span>

#include "polynomial/node_polynomials.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kRowsPerAsymmetricUnknown = 2.5;  // of the rays, when there are more
constexpr std::size_t kLeastRows = 400;

}  // namespace

std::optional<ChebyshevSum> AsymmetricSystems::fit(const WeightedRays& weighted, const Parities& parities,
                                                   int wavelength_step, const RayValue& value, double negligible) {
  const One& one = system(weighted, parities);
  if (!one.squares) return std::nullopt;
  std::vector<std::vector<double>> right;
  for (int l = 0; l < kWavelengths; l += wavelength_step) {
    std::vector<double>& values = right.emplace_back();
    for (const std::size_t k : one.rows)
      values.push_back(weighted.weight[k] * value(static_cast<std::size_t>(l), weighted.used[k]));
  }
  return assembled(degree_, one.terms, one.squares->solve_all(right), 0, negligible);
}

const AsymmetricSystems::One& AsymmetricSystems::system(const WeightedRays& weighted, const Parities& parities) {
  for (const std::unique_ptr<One>& one : made_)
    if (one->weighted == &weighted && one->parities == parities) return *one;
  One& one = *made_.emplace_back(std::make_unique<One>());
  one.weighted = &weighted;
  one.parities = parities;
  one.terms = static_cast<std::size_t>(asymmetric_term_count(degree_, parities));
  const std::size_t rays = weighted.used.size();
  if (static_cast<double>(rays) < kSamplesPerUnknown * static_cast<double>(one.terms)) return one;
  const std::size_t wanted = std::min(
      rays, std::max(kLeastRows, static_cast<std::size_t>(kRowsPerAsymmetricUnknown * static_cast<double>(one.terms))));
  Rows rows{one.terms, {}};
  rows.values.resize(wanted * one.terms);
  for (std::size_t row = 0; row < wanted; ++row) {
    const std::size_t k = row * rays / wanted;
    one.rows.push_back(k);
    const std::span<double> values = std::span(rows.values).subspan(row * one.terms, one.terms);
    asymmetric_term_values(degree_, parities, points_[weighted.used[k]], values);
    for (double& v : values) v *= weighted.weight[k];
  }
  one.squares.emplace(rows, kRidge);
  return one;
}

}  // namespace contrejour::inline internal::polynomial
