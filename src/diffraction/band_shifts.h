// SPDX-License-Identifier: Apache-2.0
// A light's wavelengths as shifts of a pattern's rows: wavelength scales the pattern, and the radii of rows form a
// geometric sequence.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contrejour/expert/colour.h"

namespace contrejour::inline internal {

// The weights of bands, by the number of rows by which a band moves the pattern outwards.
struct BandShifts {
  double lambda_nm = 0;  // not moved
  int first = 0;  // rows
  std::vector<std::array<float, 3>> weight;

  [[nodiscard]] int last() const { return first + static_cast<int>(weight.size()) - 1; }
};

[[nodiscard]] BandShifts shifts_of(std::span<const SpectralBand> bands);

}  // namespace contrejour::inline internal
