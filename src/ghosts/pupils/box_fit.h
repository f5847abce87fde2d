// A box of the pupil found at one wavelength, made to fit what comes through near it at another.
#pragma once

#include <optional>

#include "ghosts/pupils/clearance_grid.h"

namespace contrejour::pupils {

class BoxFitter {
 public:
  // path: from any point of the entrance plane.
  BoxFitter(PacketPath path, const EntranceWindow& window);

  // box: one that touches y = 0 is symmetric in y, others lie above it; so is the answer. None if nothing comes
  // through.
  [[nodiscard]] std::optional<Rectangle> fit(const Rectangle& box);

  [[nodiscard]] std::uint64_t rays() const { return grid_.rays(); }
  [[nodiscard]] std::uint64_t surface_hits() const { return grid_.rays() * grid_.steps(); }

 private:
  ClearanceGrid grid_;
  Rectangle window_;  // its upper half
};

}  // namespace contrejour::pupils
