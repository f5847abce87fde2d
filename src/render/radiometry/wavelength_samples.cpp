// SPDX-License-Identifier: Apache-2.0
#include "render/radiometry/wavelength_samples.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {

WavelengthSamples::WavelengthSamples(std::span<const double> lambda_nm, std::size_t most) {
  if (lambda_nm.empty()) return;
  for (const double lambda : lambda_nm) place_.push_back(1.0 / (lambda * lambda));
  const auto [low, high] = std::minmax_element(place_.begin(), place_.end());
  const double middle = 0.5 * (*low + *high), half = std::max(0.5 * (*high - *low), 1e-300);
  for (double& place : place_) place = (place - middle) / half;

  std::vector<double> product(place_.size(), 1.0);  // of the distances from the wavelengths chosen before
  const auto shortest = std::max_element(place_.begin(), place_.end());
  for (auto next = static_cast<std::size_t>(shortest - place_.begin()); order_.size() < most && product[next] > 0.0;) {
    order_.push_back(next);
    for (std::size_t k = 0; k < place_.size(); ++k) product[k] *= std::abs(place_[k] - place_[order_.back()]);
    next = static_cast<std::size_t>(std::max_element(product.begin(), product.end()) - product.begin());
  }
}

std::vector<double> WavelengthSamples::factors(std::size_t count, std::size_t wavelength) const {
  std::vector<double> factors(count, 1.0);
  for (std::size_t k = 0; k < count; ++k) {
    const double at = place_[order_[k]];
    for (std::size_t other = 0; other < count; ++other) {
      if (other == k) continue;
      const double from = place_[order_[other]];
      factors[k] *= (place_[wavelength] - from) / (at - from);
    }
  }
  return factors;
}

std::vector<double> WavelengthSamples::shares(std::size_t count, std::size_t wavelength) const {
  std::vector<double> shares(count, 0.0);
  const double place = place_[wavelength];
  std::size_t below = count, above = count;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = place_[order_[k]];
    if (at <= place && (below == count || at > place_[order_[below]])) below = k;
    if (at >= place && (above == count || at < place_[order_[above]])) above = k;
  }
  if (below == count || above == count || below == above) {
    shares[below == count ? above : below] = 1.0;
    return shares;
  }
  const double from = place_[order_[below]], to = place_[order_[above]];
  shares[above] = (place - from) / (to - from);
  shares[below] = 1.0 - shares[above];
  return shares;
}

}  // namespace contrejour::inline internal
