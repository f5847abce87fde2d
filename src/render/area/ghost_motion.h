// How a ghost moves over the sensor as its light moves, and how large it is: first derivatives at one of its rays.
#pragma once

#include "contrejour/light_source.h"
#include "contrejour/trace.h"
#include "render/area/linear_map.h"

namespace contrejour::area {

struct GhostMotion {
  // Sensor mm for a light so far to the right and up (tangents, direction_beside), through the same place of the stop.
  LinearMap shift_mm = kNowhere;
  LinearMap spread_mm = kNowhere;  // sensor mm for a stop radius
  Vec2 at_mm;  // where that ray lands
  double density = 0.0;  // the irradiance there over the light's; 0: no ray was found that gets through, or nearly
};

// At the ray through the middle of the stop, or where that is blocked at the ray of a grid that comes closest to
// getting through.
[[nodiscard]] GhostMotion ghost_motion(const LensState& lens, Ghost ghost, const LightSource& source, double lambda_nm);

}  // namespace contrejour::area
