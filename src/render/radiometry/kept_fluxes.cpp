// SPDX-License-Identifier: Apache-2.0
#include "render/radiometry/kept_fluxes.h"

#include <utility>

namespace contrejour::inline internal {

KeptFluxes::Key KeptFluxes::key_of(const LensState& lens) {
  return {lens.surfaces, lens.stop_index, lens.stop_radius_mm, lens.sensor_z_mm, lens.iris, lens.absorption};
}

NumberKey KeptFluxes::key_of(const LightSource& light, std::span<const SpectralBand> bands) {
  NumberKey key{light.direction.x, light.direction.y, light.direction.z, light.distance_mm};
  for (const SpectralBand& band : bands) key.add(band.lambda_nm);
  return key;
}

std::optional<std::vector<double>> KeptFluxes::find(const LightSource& light, std::span<const SpectralBand> bands) {
  return fluxes_.find(key_of(light, bands));
}

void KeptFluxes::keep(const LightSource& light, std::span<const SpectralBand> bands, std::span<const double> flux_mm2) {
  NumberKey key = key_of(light, bands);
  const std::size_t bytes = key.bytes() + flux_mm2.size() * sizeof(double) + 128;
  fluxes_.keep(std::move(key), {flux_mm2.begin(), flux_mm2.end()}, bytes);
}

}  // namespace contrejour::inline internal
