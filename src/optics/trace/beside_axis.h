#pragma once

#include "contrejour/trace.h"

namespace contrejour {

// Where a ray that meets a step's surface at this place passes beside the surface's own axis.
[[nodiscard]] Vec2 beside_axis(const PathStep& step, Vec3 position_mm);

}  // namespace contrejour
