// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/band_set.h"

#include <utility>

namespace contrejour::inline internal::ray_maps {
namespace {

std::vector<double> geometry_of(const Band& band, const WavelengthSamples& samples, std::size_t count) {
  if (band.mix.empty()) return samples.factors(count, band.middle());
  std::vector<double> mixed(count, 0.0);
  for (std::size_t pass = band.first; pass < band.last; ++pass) {
    const std::vector<double> factors = samples.factors(count, pass);
    for (std::size_t k = 0; k < count; ++k) mixed[k] += band.mix[pass - band.first] * factors[k];
  }
  return mixed;
}

// The factors that make a band's patch from the samples' patches: its geometry, and the light of all its wavelengths.
PatchBlend blend_of(const Band& band, std::span<const PlannedPass> passes, const WavelengthSamples& samples,
                    const FirstRays& rays) {
  const std::size_t count = rays.samples;
  PatchBlend blend;
  blend.geometry = geometry_of(band, samples, count);
  const bool is_one = band.last - band.first == 1;
  blend.weight.assign(is_one ? 1 : 3, std::vector<double>(count, 0.0));
  if (is_one) blend.gain = passes[band.first].gain;
  for (std::size_t pass = band.first; pass < band.last; ++pass) {
    const std::vector<double> factors = light_factors(samples, count, pass, rays.is_linear);
    for (std::size_t c = 0; c < blend.weight.size(); ++c) {
      const double gain = is_one ? 1.0 : passes[pass].gain[c];
      for (std::size_t k = 0; k < count; ++k) blend.weight[c][k] += gain * rays.light[pass] * factors[k];
    }
  }
  return blend;
}

}  // namespace

BandSet::BandSet(GhostTracers& tracers, const Band& band, BandLight light)
    : tracers_(tracers), bands_{band}, traced_{band.middle()}, lights_{std::move(light)} {}

BandSet::BandSet(GhostTracers& tracers, const WavelengthSamples& samples, const FirstRays& rays,
                 std::span<const Band> bands)
    : tracers_(tracers), bands_(bands.begin(), bands.end()), lights_(bands.size()), rays_(&rays) {
  for (std::size_t k = 0; k < rays.samples; ++k) traced_.push_back(samples[k]);
  for (const Band& band : bands) blends_.push_back(blend_of(band, tracers.passes(), samples, rays));
}

BandSet BandSet::alone(std::size_t k) {
  if (!lights_[k]) lights_[k] = light_of_band(*rays_, bands_[k], tracers_.passes(), bands_.size());
  return {tracers_, bands_[k], *lights_[k]};
}

std::vector<LobattoRays> BandSet::trace(const Rectangle& box, int nodes, PacketPrecision precision) {
  std::vector<LobattoRays> ray_sets;
  for (const std::size_t pass : traced_) ray_sets.push_back(tracers_.at(pass).trace(box, nodes, precision));
  return ray_sets;
}

void BandSet::add_weights(std::vector<LobattoRays>& ray_sets, PacketPrecision precision) {
  if (!blends_.empty()) {
    for (LobattoRays& ray_set : ray_sets) add_light(ray_set, ray_set.transmission, {1.0, 1.0, 1.0});
    return;
  }
  LobattoRays& ray_set = ray_sets.front();
  const BandLight& light = *lights_.front();
  for (std::size_t k = 0; k < light.passes.size(); ++k) {
    const std::size_t pass = light.passes[k];
    if (pass == traced_.front())
      add_light(ray_set, ray_set.transmission, light.gains[k]);
    else
      add_light(ray_set, tracers_.at(pass).transmissions(ray_set.box, ray_set.nodes, precision), light.gains[k]);
  }
}

std::vector<Patch> BandSet::make_patches(std::span<const LobattoRays> ray_sets, const Frame& frame) const {
  return ray_maps::make_patches(ray_sets, tracers_.light(), frame);
}

void BandSet::band_patch(std::span<const Patch> patches, std::size_t band, Patch& out) const {
  if (blends_.empty())
    out = patches.front();
  else
    blend(patches, blends_[band], out);
}

}  // namespace contrejour::inline internal::ray_maps
