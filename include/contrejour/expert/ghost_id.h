// SPDX-License-Identifier: Apache-2.0
// Identifies a ghost by the surfaces that its light reflects at.
#pragma once

#include <array>
#include <compare>
#include <string>

#include "contrejour/export.h"

namespace contrejour {

// Surfaces count from 1. The light reflects first at j, then at i < j; of four reflections then at l > i and at k < l.
struct Ghost {
  int i = 0;
  int j = 0;
  int k = 0, l = 0;  // 0: two reflections
  std::array<int, 2> order{0, 0};  // of diffraction in x and y at the sensor, where its pixels are a grating

  [[nodiscard]] bool reflects_four_times() const { return l != 0; }
  [[nodiscard]] bool reflects_at(int surface) const {
    return surface == i || surface == j || (reflects_four_times() && (surface == k || surface == l));
  }
  [[nodiscard]] int farthest() const { return l > j ? l : j; }
  friend auto operator<=>(const Ghost&, const Ghost&) = default;
};

// "2-5", "2-5-1-4", of another order "7-12@1,-2".
[[nodiscard]] CONTREJOUR_API std::string ghost_name(const Ghost& ghost);

}  // namespace contrejour
