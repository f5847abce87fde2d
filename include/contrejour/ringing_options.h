// What diffraction at the iris does to the ghosts' rims, and to the shadows of dirt (docs/physics/diffraction.md).
// Thread-safety: plain values.
#pragma once

#include <optional>

namespace contrejour {

enum class RingingMode {
  None,
  Fresnel,  // each ghost's own fringes, from how far out of focus it is
  Hullin,  // hullin2011 eq. 5: one pattern for all ghosts, by experience
};

struct RingingOptions {
  RingingMode mode = RingingMode::None;
  std::optional<double> alpha = std::nullopt;  // Hullin: the order; default: hullin_order()
};

}  // namespace contrejour
