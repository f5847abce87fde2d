// SPDX-License-Identifier: Apache-2.0
#include "diffraction/uneven_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/scalar.h"
#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr double kStepOfSpread = 1.0 / 5.0;  // between the table's directions
constexpr double kMaxSpreads = 3.5;         // on either side: 0.05 per cent of slopes lie beyond
constexpr double kFirstK = 64.0;  // the mask's samples extend beyond this
constexpr double kFrequenciesPerOctave = 12.0;
constexpr std::size_t kFrequencies = 180;  // up to k = 2e6, beyond which only fans remain, which fall as k^-3

double k_of(std::size_t row) { return kFirstK * std::exp2(static_cast<double>(row) / kFrequenciesPerOctave); }

// Weights of a normal distribution, in steps of kStepOfSpread about its middle.
std::vector<double> slope_weights() {
  const int max_steps = static_cast<int>(std::ceil(kMaxSpreads / kStepOfSpread));
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = -max_steps; i <= max_steps; ++i) {
    const auto below = [&](double steps) { return std::erfc(-steps * kStepOfSpread / std::numbers::sqrt2); };
    weights.push_back(below(i + 0.5) - below(i - 0.5));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

UnevenEdges::UnevenEdges(const IrisOpening& opening, double slope_spread_rad, const Context& context)
    : exact_(opening) {
  if (!(slope_spread_rad >= kMinSpread_rad)) return;
  directions_ = static_cast<std::size_t>(std::ceil(kPi / (kStepOfSpread * slope_spread_rad)));
  const double step_rad = kPi / static_cast<double>(directions_);
  std::vector<float> exact(directions_ * kFrequencies);
  parallel_for(directions_, context, [&](std::size_t i) {
    const EdgeWaves::Direction direction = exact_.along(step_rad * static_cast<double>(i), step_rad);
    for (std::size_t row = 0; row < kFrequencies; ++row) {
      const double k = k_of(row);
      exact[i * kFrequencies + row] = static_cast<float>(k * k * k * direction.power(k));
    }
  });
  const std::vector<double> weights = slope_weights();
  power_k3_.resize(exact.size());
  parallel_for(directions_, context, [&](std::size_t i) {
    for (std::size_t s = 0; s < weights.size(); ++s) {
      const std::size_t from = (i + s + (weights.size() / 2) * (directions_ - 1)) % directions_;
      for (std::size_t row = 0; row < kFrequencies; ++row)
        power_k3_[i * kFrequencies + row] += static_cast<float>(weights[s]) * exact[from * kFrequencies + row];
    }
  });
}

UnevenEdges::Direction UnevenEdges::along(double direction_rad, double window_rad) const {
  Direction direction;
  if (directions_ == 0) {
    direction.exact_ = exact_.along(direction_rad, window_rad);
    return direction;
  }
  const double turns = direction_rad / kPi, at = (turns - std::floor(turns)) * static_cast<double>(directions_);
  const std::size_t here = static_cast<std::size_t>(at) % directions_;
  direction.here_ = power_k3_.data() + here * kFrequencies;
  direction.next_ = power_k3_.data() + (here + 1) % directions_ * kFrequencies;
  direction.next_weight_ = at - std::floor(at);
  return direction;
}

double UnevenEdges::Direction::power(double k) const {
  if (exact_) return exact_->power(k);
  const double at = std::clamp(kFrequenciesPerOctave * std::log2(k / kFirstK), 0.0, kFrequencies - 1.001);
  const auto row = static_cast<std::size_t>(at);
  const double t = at - static_cast<double>(row);
  const auto along_rows = [&](const float* rows) { return std::lerp(rows[row], rows[row + 1], t); };
  return std::lerp(along_rows(here_), along_rows(next_), next_weight_) / (k * k * k);
}

}  // namespace contrejour::inline internal
