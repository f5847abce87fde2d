// The blades of an iris at an f-number, and what an iris may be.
#pragma once

#include "contrejour/iris.h"
#include "contrejour/result.h"

namespace contrejour {

struct ClosedIris {
  Iris iris;
  double stop_radius_mm = 0;
};

// Blades closed over a round hole until what they leave has the area of a circle of round_radius_mm (hullin2011 figure
// 3; docs/physics/diffraction.md). The stop's radius becomes the reach of the opening's farthest point, the iris's
// blade_radius is in units of it; no blades where the hole is no larger than the circle.
[[nodiscard]] ClosedIris close_iris(const Iris& iris, double round_radius_mm, double hole_radius_mm);

// Errors: numbers that are not finite or out of their range (iris.h), blades that let nothing through.
[[nodiscard]] Result<void> check_iris(const Iris& iris);

}  // namespace contrejour
