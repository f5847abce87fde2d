// SPDX-License-Identifier: Apache-2.0
// Diffraction at the edges of ghosts, by the iris, and at the shadows of dirt (docs/physics/diffraction.md).
// Thread-safety: plain values.
#pragma once

#include <optional>

namespace contrejour {

enum class RingingMode {
  None,
  Fresnel,  // each ghost has its own fringes, which depend on its defocus
  Hullin,  // hullin2011 eq. 5: one empirical pattern for all ghosts
};

struct RingingOptions {
  RingingMode mode = RingingMode::None;
  std::optional<double> alpha = std::nullopt;  // Hullin: the order; default: hullin_order()
};

}  // namespace contrejour
