// Bands of wavelengths that are drawn through the same boxes of the pupil: either one, with the geometry of one of its
// wavelengths, or all, told from rays at some of their wavelengths.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/adaptive/maps/ghost_tracers.h"
#include "render/adaptive/maps/patch.h"
#include "render/adaptive/maps/wavelength_bands.h"

namespace contrejour::adaptive {

class BandSet {
 public:
  // One: rays at its middle, transmissions at all of its wavelengths.
  BandSet(GhostTracers& tracers, const Band& band);
  // All: rays at those samples that tell in the first rays.
  BandSet(GhostTracers& tracers, const WavelengthSamples& samples, const FirstRays& rays, std::span<const Band> bands);

  [[nodiscard]] std::size_t size() const { return bands_.size(); }
  [[nodiscard]] const Band& band(std::size_t k) const { return bands_[k]; }

  // One for each wavelength with rays.
  [[nodiscard]] std::vector<RaySheet> trace(const Rectangle& box, int nodes, PacketPrecision precision);
  // What sheets still lack that are going to be drawn.
  void add_weights(std::vector<RaySheet>& sheets, PacketPrecision precision);
  // Of sheets with weights, one at least of whose rays all arrived; what band_patch() makes a band's patch of.
  [[nodiscard]] std::vector<Patch> make_patches(std::span<const RaySheet> sheets, const Frame& frame) const;
  void band_patch(std::span<const Patch> patches, std::size_t band, Patch& out) const;

 private:
  GhostTracers& tracers_;
  std::vector<Band> bands_;
  std::vector<std::size_t> traced_;  // passes
  std::vector<PatchBlend> blends_;   // one a band; none: there is one band
};

}  // namespace contrejour::adaptive
