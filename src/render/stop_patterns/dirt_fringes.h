// SPDX-License-Identifier: Apache-2.0
// Diffraction shadows of dirt: planes of shadows with fringes, by wavelength times effective distance, as a section of
// RenderCache.
// Thread-safety: make() from one thread at a time; all else from any thread, afterwards.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/dirt.h"
#include "render/planning/dirt_field.h"
#include "render/stop_patterns/dirt_diffraction.h"

namespace contrejour::inline internal::stop_patterns {

class DirtFringes {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{512} << 20U;  // from frame to frame
  struct Key {
    Dirt dirt;
    double extent_mm = 0.0;  // of its plane
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Request {
    double lambda_z_mm2 = 1.0;  // at the middle of the band
    double spread = 0.0;  // RMS spread of its wavelengths over their mean
  };

  explicit DirtFringes(const Key& /*key*/) {}

  // field: must be of the key's dirt and plane. Makes the planes that do not exist yet, on all threads. Returns false
  // if cancelled.
  bool make(const DirtField& field, std::span<const Request> requested, const Context& context);
  [[nodiscard]] std::shared_ptr<const DirtDiffraction> plane(const Request& requested) const;  // null unless made
  [[nodiscard]] std::size_t count() const { return planes_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct PlaneKey {
    int node = 0, spread = 0;
    friend auto operator<=>(const PlaneKey&, const PlaneKey&) = default;
  };
  [[nodiscard]] static PlaneKey key_of(const Request& requested);

  std::map<int, std::shared_ptr<const StraightEdge>> edges_;  // by spread
  std::map<PlaneKey, std::shared_ptr<const DirtDiffraction>> planes_;
};

}  // namespace contrejour::inline internal::stop_patterns
