// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/wavelength_flux.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::inline internal::ray_maps {
namespace {

constexpr int kNodes = 3;  // a side of the box
// Light fills the ellipse in the box, not its corners. The weights of the box's nodes, row by row, give the mean over
// the ellipse of polynomials of degree 2, and of x^2 y^2.
constexpr double kCorner = 1.0 / 96.0, kSide = 10.0 / 96.0, kMiddle = 52.0 / 96.0;
constexpr std::array<double, kNodes * kNodes> kWeights{kCorner, kSide,   kCorner, kSide,  kMiddle,
                                                       kSide,   kCorner, kSide,   kCorner};
constexpr std::array<std::size_t, 3> kSamples{7, 10, 13};
constexpr double kPredictionTolerance = 0.004;  // of the largest flux: error of a prediction

}  // namespace

WavelengthFlux::WavelengthFlux(GhostTracers& tracers, std::span<const LobattoRays> ray_sets,
                               const WavelengthSamples& samples, std::size_t count)
    : tracers_(tracers), ray_sets_(ray_sets), samples_(samples) {
  const auto nodes = static_cast<std::size_t>(ray_sets[samples[0]].nodes);
  const std::size_t step = (nodes - 1) / (kNodes - 1);
  for (std::size_t iy = 0; iy < kNodes; ++iy)
    for (std::size_t ix = 0; ix < kNodes; ++ix) at_.push_back((iy * nodes + ix) * step);
  for (const std::size_t node : at_) {
    bool arrives = true;
    for (std::size_t k = 0; k < count; ++k) arrives = arrives && ray_sets[samples[k]].counts(node);
    counts_.push_back(arrives);
  }
}

bool WavelengthFlux::any() const { return std::ranges::count(counts_, true) > 0; }

double WavelengthFlux::sum(std::span<const float> transmission) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < at_.size(); ++k) sum += counts_[k] ? kWeights[k] * transmission[at_[k]] : 0.0;
  return sum;
}

std::vector<double> WavelengthFlux::of_all() {
  constexpr double kUnknown = -1.0;
  std::vector<double> light(ray_sets_.size(), kUnknown);
  for (const std::size_t count : kSamples) {
    if (count > samples_.size()) break;
    for (std::size_t k = 0; k < count; ++k)
      if (light[samples_[k]] == kUnknown) light[samples_[k]] = of(samples_[k]);
    const std::size_t last = samples_[count - 1];
    const double largest = *std::ranges::max_element(light);
    if (!(std::abs(predicted(light, count - 1, last) - light[last]) <= kPredictionTolerance * largest)) continue;
    for (std::size_t pass = 0; pass < light.size(); ++pass)
      if (light[pass] == kUnknown) light[pass] = std::max(0.0, predicted(light, count, pass));
    return light;
  }
  for (std::size_t pass = 0; pass < light.size(); ++pass)
    if (light[pass] == kUnknown) light[pass] = of(pass);
  return light;
}

double WavelengthFlux::of(std::size_t pass) {
  const LobattoRays& ray_set = ray_sets_[pass];
  if (ray_set.nodes > 0) return sum(ray_set.transmission);
  const std::vector<float> light =
      tracers_.at(pass).transmissions(ray_sets_[samples_[0]].box, kNodes, PacketPrecision::Double);
  double sum = 0.0;
  for (std::size_t k = 0; k < light.size(); ++k) sum += counts_[k] ? kWeights[k] * light[k] : 0.0;
  return sum;
}

double WavelengthFlux::predicted(const std::vector<double>& light, std::size_t count, std::size_t pass) const {
  const std::vector<double> factors = samples_.factors(count, pass);
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += factors[k] * light[samples_[k]];
  return sum;
}

}  // namespace contrejour::inline internal::ray_maps
