// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal {

// The x and y in the surface's own frame of a point on a step's surface.
[[nodiscard]] Vec2 height_vector(const PathStep& step, Vec3 position_mm);

}  // namespace contrejour::inline internal
