// SPDX-License-Identifier: Apache-2.0
// The starbursts that a session has made, a section of RenderCache: a light that stays where it is has the same one in
// the next frame, whatever its brightness.
// Thread-safety: get() from any thread; all else from one thread at a time.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/number_key.h"
#include "base/recently_used.h"
#include "contrejour/expert/lens_starburst.h"

namespace contrejour::inline internal {

class KeptStarbursts {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20U;  // nine at 1920 x 1080

  // The properties of a lens that starbursts depend on.
  struct Key {
    std::vector<SurfaceState> surfaces;
    int stop_index = 0;
    double stop_radius_mm = 0.0, sensor_z_mm = 0.0, design_wavelength_nm = 0.0;
    Iris iris;
    Dirt dirt;
    bool absorption = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const LensState& lens);

  explicit KeptStarbursts(const Key& /*key*/) : starbursts_(kMostBytes) {}

  // The arguments of lens_starburst().
  struct Request {
    LightSource light;
    std::span<const SpectralBand> bands;
    LensStarburstSettings settings;
  };
  // The starburst of an earlier frame, or the result of make(), which is kept unless it is an error.
  template <class Make>
  [[nodiscard]] Result<Starburst> get(const Request& request, const Make& make) {
    NumberKey key = key_of(request);
    if (auto kept = starbursts_.find(key)) return *std::move(kept);
    Result<Starburst> made = make();
    if (made) keep(std::move(key), *made);
    return made;
  }

  void next_frame() { starbursts_.next_frame(); }
  [[nodiscard]] std::size_t memory_bytes() const { return starbursts_.bytes(); }

 private:
  [[nodiscard]] static NumberKey key_of(const Request& request);
  void keep(NumberKey key, const Starburst& starburst);

  RecentlyUsed<NumberKey, Starburst> starbursts_;
};

}  // namespace contrejour::inline internal
