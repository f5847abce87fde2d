// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/kept_starbursts.h"

#include <utility>

#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

KeptStarbursts::Key KeptStarbursts::key_of(const LensState& lens) {
  return {lens.surfaces, lens.stop_index, lens.stop_radius_mm, lens.sensor_z_mm, lens.design_wavelength_nm,
          lens.iris,     lens.dirt,       lens.absorption};
}

NumberKey KeptStarbursts::key_of(const Request& request) {
  const auto& [light, bands, settings] = request;
  NumberKey key{light.direction.x, light.direction.y,       light.direction.z,
                light.distance_mm, settings.pixel_pitch_mm, settings.radius_px};
  for (const SpectralBand& band : bands) {
    key.add(band.lambda_nm);
    for (const double weight : band.weight) key.add(weight);
  }
  return key;
}

void KeptStarbursts::keep(NumberKey key, const Starburst& starburst) {
  const std::size_t bytes = key.bytes() + (starburst.rings() != nullptr ? starburst.rings()->bytes() : 0);
  starbursts_.keep(std::move(key), starburst, bytes);
}

}  // namespace contrejour::inline internal
