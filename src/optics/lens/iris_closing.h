// SPDX-License-Identifier: Apache-2.0
// The blades of an iris at an f-number, and the check of an iris's numbers.
#pragma once

#include "contrejour/expert/iris.h"
#include "contrejour/result.h"

namespace contrejour::inline internal {

struct ClosedIris {
  Iris iris;
  double stop_radius_mm = 0;
};

// Closes blades over a round hole until the opening has the area of a circle of round_radius_mm (hullin2011 figure 3;
// docs/physics/diffraction.md). The stop's radius becomes that of the opening's farthest point, in units of which
// blade_radius is given; there are no blades if the hole is not larger than the circle.
[[nodiscard]] ClosedIris close_iris(const Iris& iris, double round_radius_mm, double hole_radius_mm);

// Errors: numbers that are not finite or out of their range (iris.h), blades that let nothing through.
[[nodiscard]] Result<void> check_iris(const Iris& iris);

}  // namespace contrejour::inline internal
