// SPDX-License-Identifier: Apache-2.0
// The direct fluxes that a session has measured, a section of RenderCache: those of a light that stays where it is are
// the same in the next frame, whatever its colour and brightness.
// Thread-safety: from one thread at a time.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/number_key.h"
#include "base/recently_used.h"
#include "contrejour/expert/colour.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

class KeptFluxes {
 public:
  // The properties of a lens that its direct image's flux depends on: all but its dirt.
  struct Key {
    std::vector<SurfaceState> surfaces;
    int stop_index = 0;
    double stop_radius_mm = 0.0, sensor_z_mm = 0.0;
    Iris iris;
    bool absorption = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const LensState& lens);

  explicit KeptFluxes(const Key& /*key*/) : fluxes_(kMaxBytes) {}

  // mm^2 at E0 = 1, one a band; nullopt where they were not kept.
  [[nodiscard]] std::optional<std::vector<double>> find(const LightSource& light, std::span<const SpectralBand> bands);
  void keep(const LightSource& light, std::span<const SpectralBand> bands, std::span<const double> flux_mm2);

  void next_frame() { fluxes_.next_frame(); }
  [[nodiscard]] std::size_t memory_bytes() const { return fluxes_.bytes(); }

 private:
  static constexpr std::size_t kMaxBytes = std::size_t{16} << 20U;  // some ten thousand lights

  // The light's direction and distance, then the wavelengths.
  [[nodiscard]] static NumberKey key_of(const LightSource& light, std::span<const SpectralBand> bands);

  RecentlyUsed<NumberKey, std::vector<double>> fluxes_;
};

}  // namespace contrejour::inline internal
