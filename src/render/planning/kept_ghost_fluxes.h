// SPDX-License-Identifier: Apache-2.0
// The fluxes of ghosts by which a session has ranked them, a section of RenderCache: the ghosts of a light that stays
// where it is have the same in the next frame, whatever its colour and brightness.
// Thread-safety: safe.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/number_key.h"
#include "base/recently_used.h"
#include "contrejour/expert/ghost_id.h"
#include "render/pupils/ghost_pupil.h"
#include "render/pupils/kept_pupils.h"
#include "render/radiometry/kept_fluxes.h"

namespace contrejour::inline internal {

class KeptGhostFluxes {
 public:
  // The properties of a lens that its ghosts' fluxes depend on.
  struct Key {
    KeptFluxes::Key transmission;
    pupils::KeptPupils::Key pupils;
    double grating_fill = 0.0;  // of the sensor
    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const LensState& lens) {
    return {KeptFluxes::key_of(lens), pupils::KeptPupils::key_of(lens), lens.sensor_grating.fill};
  }

  explicit KeptGhostFluxes(const Key& /*key*/) : fluxes_(kMaxBytes) {}

  // The flux within a rectangle of the sensor at each wavelength: that of an earlier frame, or that of measure(), which
  // is then kept. request: of a lens with this section's key.
  template <class Measure>
  [[nodiscard]] std::vector<double> get(const pupils::PupilRequest& request, std::span<const double> lambda_nm,
                                        const Rectangle& sensor_mm, const Measure& measure) {
    FluxKey key = key_of(request, lambda_nm, sensor_mm);
    if (auto kept = fluxes_.find(key)) return *std::move(kept);
    std::vector<double> fluxes = measure();
    const std::size_t bytes = key.second.bytes() + fluxes.size() * sizeof(double) + kEntryBytes;
    fluxes_.keep(std::move(key), fluxes, bytes);
    return fluxes;
  }

  void next_frame() { fluxes_.next_frame(); }
  [[nodiscard]] std::size_t memory_bytes() const { return fluxes_.bytes(); }

 private:
  static constexpr std::size_t kMaxBytes = std::size_t{32} << 20U;  // 80 000 ghosts
  static constexpr std::size_t kEntryBytes = 192;  // about what a key and the map's node take

  // The light, the rectangle, the wavelengths that the pupil was searched at, and those that were measured.
  using FluxKey = std::pair<Ghost, NumberKey>;
  [[nodiscard]] static FluxKey key_of(const pupils::PupilRequest& request, std::span<const double> lambda_nm,
                                      const Rectangle& sensor_mm) {
    const LightSource& light = request.light;
    NumberKey key{light.direction.x, light.direction.y, light.direction.z, light.distance_mm, request.stop_times,
                  sensor_mm.low.x,   sensor_mm.low.y,   sensor_mm.high.x,  sensor_mm.high.y};
    for (const std::span<const double> wavelengths : {request.lambda_nm, lambda_nm})
      for (const double nm : wavelengths) key.add(nm);
    return {request.ghost, std::move(key)};
  }

  RecentlyUsed<FluxKey, std::vector<double>> fluxes_;
};

}  // namespace contrejour::inline internal
