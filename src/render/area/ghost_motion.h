// How a ghost moves over the sensor as its light moves, and how large it is: first derivatives at some of its rays.
#pragma once

#include <vector>

#include "contrejour/light_source.h"
#include "ghosts/light_frame.h"
#include "optics/trace/lens_steps.h"
#include "render/area/linear_map.h"

namespace contrejour::area {

// A line that a ghost's light ends at or gathers along, near where a ray lands: a part of its outline, or a caustic.
struct GhostFeature {
  Vec2 normal;      // to it, unit, on the sensor
  Vec2 shift_mm;    // along the normal, as the light goes right and up by a unit (tangents, direction_beside)
  Vec2 at_mm;
  double density = 0.0;  // the irradiance there over the light's
  bool is_border = true;  // of the outline
};

struct GhostMotion {
  // Sensor mm for a light so far to the right and up (tangents, direction_beside), through the same place of what
  // bounds the ghost: at the ray amid it.
  LinearMap shift_mm = kNowhere;
  LinearMap spread_mm = kNowhere;  // sensor mm of the unit circle's image, a disc as large as the ghost
  Vec2 at_mm;                      // the middle of the light
  double flux_mm2 = 0.0;           // of the light's irradiance; 0: no ray was found that gets through, or nearly
  bool is_open = false;
  double outside = 0.0;  // of one that is not: how far beyond what blocks it the ray is that is blocked least
  // By how much the area of its pupil changes for a light so far to the right and up, over that area.
  Vec2 area_rate;
  std::vector<GhostFeature> features;
};

// At the wavelength of the steps. windows: of the light.
[[nodiscard]] GhostMotion ghost_motion(const LensSteps& steps, Ghost ghost, const LightSource& source,
                                       const LightWindows& windows);

}  // namespace contrejour::area
