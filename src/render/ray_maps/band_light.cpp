// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/band_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace contrejour::inline internal::ray_maps {
namespace {

// The part of the tolerance of weights that the choice of passes may use, and the largest error of the flux.
constexpr double kWeightFraction = 0.5, kMaxFluxError = 0.004;

BandLight of_all(const Band& band, std::span<const PlannedPass> passes) {
  BandLight light;
  for (std::size_t pass = band.first; pass < band.last; ++pass) {
    light.passes.push_back(pass);
    light.gains.push_back(passes[pass].gain);
  }
  return light;
}

// The whole band with the transmittance of its middle pass, which is traced in any case.
BandLight of_middle(const Band& band, std::span<const PlannedPass> passes) {
  BandLight light{{band.middle()}, {Rgb{}}};
  for (std::size_t pass = band.first; pass < band.last; ++pass)
    for (std::size_t c = 0; c < 3; ++c) light.gains[0][c] += passes[pass].gain[c];
  return light;
}

// samples: of the band's passes alone.
BandLight of_samples(const Band& band, std::span<const PlannedPass> passes, const WavelengthSamples& samples,
                     std::size_t count) {
  BandLight light;
  for (std::size_t k = 0; k < count; ++k) light.passes.push_back(band.first + samples[k]);
  light.gains.resize(count);
  for (std::size_t pass = band.first; pass < band.last; ++pass) {
    const std::vector<double> factors = samples.factors(count, pass - band.first);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < 3; ++c) light.gains[k][c] += factors[k] * passes[pass].gain[c];
  }
  return light;
}

Rgb at_node(const BandLight& light, const FirstRays& rays, std::size_t node) {
  Rgb sum{};
  for (std::size_t k = 0; k < light.passes.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += light.gains[k][c] * rays.transmission[light.passes[k]][node];
  return sum;
}

// The nodes whose rays arrive at all traced wavelengths.
std::vector<std::size_t> arriving_nodes(const FirstRays& rays) {
  std::vector<std::size_t> nodes;
  for (std::size_t node = 0; node < rays.transmission.front().size(); ++node)
    if (std::ranges::all_of(rays.ray_sets, [&](const LobattoRays& set) { return set.nodes == 0 || set.counts(node); }))
      nodes.push_back(node);
  return nodes;
}

}  // namespace

BandLight light_of_band(const FirstRays& rays, const Band& band, std::span<const PlannedPass> passes,
                        std::size_t band_count) {
  BandLight all = of_all(band, passes);
  const std::size_t count = all.passes.size();
  const std::vector<std::size_t> nodes = arriving_nodes(rays);
  if (count == 1 || nodes.empty()) return all;
  const double allowed = std::min(kWeightFraction * rays.tolerance.weight, kMaxFluxError) * rays.largest_weight /
                         static_cast<double>(band_count);
  const auto holds = [&](const BandLight& light) {
    return std::ranges::all_of(nodes, [&](std::size_t node) {
      const Rgb is = at_node(all, rays, node), found = at_node(light, rays, node);
      return std::abs(found[0] - is[0]) <= allowed && std::abs(found[1] - is[1]) <= allowed &&
             std::abs(found[2] - is[2]) <= allowed;
    });
  };
  if (BandLight middle = of_middle(band, passes); holds(middle)) return middle;
  std::vector<double> lambda_nm;
  for (const std::size_t pass : all.passes) lambda_nm.push_back(passes[pass].lambda_nm);
  const WavelengthSamples samples(lambda_nm, count);
  for (std::size_t k = 2; k + 1 < std::min(count, samples.size()); ++k)
    if (BandLight light = of_samples(band, passes, samples, k); holds(light)) return light;
  return all;
}

}  // namespace contrejour::inline internal::ray_maps
