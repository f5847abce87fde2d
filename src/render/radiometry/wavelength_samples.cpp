// SPDX-License-Identifier: Apache-2.0
#include "render/radiometry/wavelength_samples.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {

WavelengthSamples::WavelengthSamples(std::span<const double> lambda_nm, std::size_t max_count) {
  if (lambda_nm.empty()) return;
  for (const double lambda : lambda_nm) position_.push_back(1.0 / (lambda * lambda));
  const auto [low, high] = std::minmax_element(position_.begin(), position_.end());
  const double middle = 0.5 * (*low + *high), half = std::max(0.5 * (*high - *low), 1e-300);
  for (double& position : position_) position = (position - middle) / half;

  std::vector<double> product(position_.size(), 1.0);  // of the distances from the wavelengths chosen before
  const auto shortest = std::max_element(position_.begin(), position_.end());
  for (auto next = static_cast<std::size_t>(shortest - position_.begin());
       order_.size() < max_count && product[next] > 0.0;) {
    order_.push_back(next);
    for (std::size_t k = 0; k < position_.size(); ++k) product[k] *= std::abs(position_[k] - position_[order_.back()]);
    next = static_cast<std::size_t>(std::max_element(product.begin(), product.end()) - product.begin());
  }
}

std::vector<double> WavelengthSamples::factors(std::size_t count, std::size_t wavelength) const {
  std::vector<double> factors(count, 1.0);
  for (std::size_t k = 0; k < count; ++k) {
    const double at = position_[order_[k]];
    for (std::size_t other = 0; other < count; ++other) {
      if (other == k) continue;
      const double from = position_[order_[other]];
      factors[k] *= (position_[wavelength] - from) / (at - from);
    }
  }
  return factors;
}

std::vector<double> WavelengthSamples::linear_weights(std::size_t count, std::size_t wavelength) const {
  std::vector<double> linear_weights(count, 0.0);
  const double position = position_[wavelength];
  std::size_t below = count, above = count;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = position_[order_[k]];
    if (at <= position && (below == count || at > position_[order_[below]])) below = k;
    if (at >= position && (above == count || at < position_[order_[above]])) above = k;
  }
  if (below == count || above == count || below == above) {
    linear_weights[below == count ? above : below] = 1.0;
    return linear_weights;
  }
  const double from = position_[order_[below]], to = position_[order_[above]];
  linear_weights[above] = (position - from) / (to - from);
  linear_weights[below] = 1.0 - linear_weights[above];
  return linear_weights;
}

}  // namespace contrejour::inline internal
