// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/pass_light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::inline internal::ray_maps {
namespace {

constexpr int kNodes = 3;  // a side of the box
constexpr std::array<std::size_t, 3> kSamples{7, 10, 13};
constexpr double kForetold = 0.004;  // of the largest flux: error of a prediction

}  // namespace

PassLight::PassLight(GhostTracers& tracers, std::span<const RaySheet> sheets, const WavelengthSamples& samples,
                     std::size_t count)
    : tracers_(tracers), sheets_(sheets), samples_(samples) {
  const auto nodes = static_cast<std::size_t>(sheets[samples[0]].nodes);
  const std::size_t step = (nodes - 1) / (kNodes - 1);
  for (std::size_t iy = 0; iy < kNodes; ++iy)
    for (std::size_t ix = 0; ix < kNodes; ++ix) at_.push_back((iy * nodes + ix) * step);
  for (const std::size_t node : at_) {
    bool arrives = true;
    for (std::size_t k = 0; k < count; ++k) arrives = arrives && sheets[samples[k]].arrives(node);
    counts_.push_back(arrives);
  }
}

bool PassLight::any() const { return std::ranges::count(counts_, true) > 0; }

double PassLight::sum(std::span<const float> transmission) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < at_.size(); ++k) sum += counts_[k] ? transmission[at_[k]] : 0.0F;
  return sum;
}

std::vector<double> PassLight::of_all() {
  constexpr double kUnknown = -1.0;
  std::vector<double> light(sheets_.size(), kUnknown);
  for (const std::size_t count : kSamples) {
    if (count > samples_.size()) break;
    for (std::size_t k = 0; k < count; ++k)
      if (light[samples_[k]] == kUnknown) light[samples_[k]] = of(samples_[k]);
    const std::size_t last = samples_[count - 1];
    const double most = *std::ranges::max_element(light);
    if (!(std::abs(told(light, count - 1, last) - light[last]) <= kForetold * most)) continue;
    for (std::size_t pass = 0; pass < light.size(); ++pass)
      if (light[pass] == kUnknown) light[pass] = std::max(0.0, told(light, count, pass));
    return light;
  }
  for (std::size_t pass = 0; pass < light.size(); ++pass)
    if (light[pass] == kUnknown) light[pass] = of(pass);
  return light;
}

double PassLight::of(std::size_t pass) {
  const RaySheet& sheet = sheets_[pass];
  if (sheet.nodes > 0) return sum(sheet.transmission);
  const std::vector<float> light =
      tracers_.at(pass).transmissions(sheets_[samples_[0]].box, kNodes, PacketPrecision::Double);
  double sum = 0.0;
  for (std::size_t k = 0; k < light.size(); ++k) sum += counts_[k] ? light[k] : 0.0F;
  return sum;
}

double PassLight::told(const std::vector<double>& light, std::size_t count, std::size_t pass) const {
  const std::vector<double> factors = samples_.factors(count, pass);
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += factors[k] * light[samples_[k]];
  return sum;
}

}  // namespace contrejour::inline internal::ray_maps
