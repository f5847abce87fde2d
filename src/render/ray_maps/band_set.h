// SPDX-License-Identifier: Apache-2.0
// Bands of wavelengths that are drawn through the same boxes of the pupil: either one band with the geometry of one of
// its wavelengths, or all bands, interpolated from rays at some of their wavelengths.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/ray_maps/band.h"
#include "render/ray_maps/band_light.h"
#include "render/ray_maps/first_rays.h"
#include "render/ray_maps/ghost_tracers.h"
#include "render/ray_maps/patch.h"

namespace contrejour::inline internal::ray_maps {

class BandSet {
 public:
  // One band: rays at its middle wavelength, transmittances at those of its light.
  BandSet(GhostTracers& tracers, const Band& band, BandLight light);
  // All bands: rays at the wavelength samples that the first rays found sufficient. rays outlives this object.
  BandSet(GhostTracers& tracers, const WavelengthSamples& samples, const FirstRays& rays, std::span<const Band> bands);

  // One of several bands.
  [[nodiscard]] BandSet alone(std::size_t k);

  [[nodiscard]] std::size_t size() const { return bands_.size(); }
  [[nodiscard]] const Band& band(std::size_t k) const { return bands_[k]; }

  // Returns one set of rays for each traced wavelength.
  [[nodiscard]] std::vector<LobattoRays> trace(const Rectangle& box, int nodes, PacketPrecision precision);
  // Computes the weights that trace() leaves out and that drawing needs.
  void add_weights(std::vector<LobattoRays>& ray_sets, PacketPrecision precision);
  // The patches of ray sets that have weights, at least one of which has no failed rays; band_patch() computes a band's
  // patch from them.
  [[nodiscard]] std::vector<Patch> make_patches(std::span<const LobattoRays> ray_sets, const Frame& frame) const;
  void band_patch(std::span<const Patch> patches, std::size_t band, Patch& out) const;

 private:
  GhostTracers& tracers_;
  std::vector<Band> bands_;
  std::vector<std::size_t> traced_;  // passes
  std::vector<PatchBlend> blends_;  // one a band; none: there is one band
  std::vector<std::optional<BandLight>> lights_;  // one a band, of bands that were needed alone
  const FirstRays* rays_ = nullptr;
};

}  // namespace contrejour::inline internal::ray_maps
