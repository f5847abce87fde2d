// How a ghost moves over the sensor as its light moves, and how large it is: first derivatives at one of its rays.
#pragma once

#include "contrejour/light_source.h"
#include "optics/trace/lens_steps.h"
#include "render/area/linear_map.h"
#include "render/interface/light_frame.h"

namespace contrejour::area {

struct GhostMotion {
  // Sensor mm for a light so far to the right and up (tangents, direction_beside), through the same places of what
  // bounds the ghost: of the stop and of a rim, by their shares of its outline.
  LinearMap shift_mm = kNowhere;
  LinearMap spread_mm = kNowhere;  // sensor mm of the unit circle's image, a disc as large as the ghost
  Vec2 at_mm;  // where a ray amid the ghost lands
  double density = 0.0;  // the irradiance there over the light's; 0: no ray was found that gets through, or nearly
};

// At the wavelength of the steps. windows: of the light.
[[nodiscard]] GhostMotion ghost_motion(const LensSteps& steps, Ghost ghost, const LightSource& source,
                                       const LightWindows& windows);

}  // namespace contrejour::area
