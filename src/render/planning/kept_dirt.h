// SPDX-License-Identifier: Apache-2.0
// The dirt of a lens with sharp shadows, a section of RenderCache: it keeps thousands of shapes sorted into cells.
// Thread-safety: field() from one thread at a time.
#pragma once

#include <memory>

#include "render/planning/dirt_field.h"

namespace contrejour::inline internal {

class KeptDirt {
 public:
  // Everything that a DirtField depends on.
  struct Key {
    Dirt dirt;
    double stop_radius_mm = 0.0, stop_rim_mm = 0.0;
    double front_z_mm = 0.0, front_rim_mm = 0.0;
    friend bool operator==(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const LensState& lens);

  explicit KeptDirt(const Key& /*key*/) {}

  // Makes the field on the first call; null where the lens is clean. lens: one with this section's key.
  [[nodiscard]] std::shared_ptr<const DirtField> field(const LensState& lens);
  [[nodiscard]] std::size_t memory_bytes() const { return field_ ? field_->bytes() : 0; }

 private:
  std::shared_ptr<const DirtField> field_;
};

}  // namespace contrejour::inline internal
