// SPDX-License-Identifier: Apache-2.0
// Linear RGB spaces as matrices.
#pragma once

#include <array>

#include "contrejour/expert/colour.h"

namespace contrejour::inline internal {

using Matrix3 = std::array<std::array<double, 3>, 3>;

struct Primaries {
  std::array<double, 2> red, green, blue, white;  // CIE x, y
};
[[nodiscard]] const Primaries& primaries_of(ColourSpace space);

// XYZ under D65 -> RGB in which D65 is (1, 1, 1).
[[nodiscard]] const Matrix3& rgb_from_xyz_matrix(ColourSpace space);
[[nodiscard]] const Matrix3& xyz_from_rgb_matrix(ColourSpace space);

[[nodiscard]] std::array<double, 3> multiply(const Matrix3& m, const std::array<double, 3>& v);

}  // namespace contrejour::inline internal
