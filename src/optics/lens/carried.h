// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// The pose of a surface that is part of a body, which is rotated about a point on the lens's axis and moved. behind_mm:
// nominal distance of the vertex behind that point; own: the surface's pose within the body. (A toroid's own rotation
// is left unchanged: the composition of two smallest rotations differs from the third by a twist of second order.)
[[nodiscard]] SurfacePose carried(const SurfacePose& body, double behind_mm, const SurfacePose& own);

}  // namespace contrejour::inline internal
