// SPDX-License-Identifier: Apache-2.0
// Fits a box of the pupil at one wavelength to the light near it at another wavelength.
#pragma once

#include <optional>

#include "ghosts/pupils/clearance_grid.h"

namespace contrejour::inline internal::pupils {

class BoxFitter {
 public:
  // path: from any point of the entrance plane.
  BoxFitter(PacketPath path, const EntranceWindow& window);

  // box: one that touches y = 0 is symmetric in y, others lie above it; the same holds for the result. None if no light
  // gets through.
  [[nodiscard]] std::optional<Rectangle> fit(const Rectangle& box);

  [[nodiscard]] std::uint64_t rays() const { return grid_.rays(); }
  [[nodiscard]] std::uint64_t surface_hits() const { return grid_.rays() * grid_.steps(); }

 private:
  ClearanceGrid grid_;
  Rectangle window_;  // its upper half
};

}  // namespace contrejour::inline internal::pupils
