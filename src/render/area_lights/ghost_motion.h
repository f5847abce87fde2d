// SPDX-License-Identifier: Apache-2.0
// How a ghost moves over the sensor as its light moves, and how large it is, from first derivatives at some of its
// rays.
#pragma once

#include <vector>

#include "base/linear_map.h"
#include "contrejour/expert/light_source.h"
#include "ghosts/light_frame.h"
#include "optics/trace/lens_steps.h"

namespace contrejour::inline internal::area {

// A line of a ghost near the point where a ray lands: a part of its outline, or of a caustic.
struct GhostLine {
  Vec2 normal;      // unit normal of the line on the sensor
  Vec2 shift_mm;    // motion along the normal for lights a unit to the right and up (tangents, offset_direction)
  Vec2 at_mm;
  double density = 0.0;  // the irradiance there over the light's
  bool is_border = true;  // whether it belongs to the outline
  double fraction = 0.0;  // of the outline, or of the pupil's area, that it stands for
  LinearMap covariance_mm2 = kZeroMap;  // of where that part of the pupil's light lands; zero at the outline
};

struct GhostMotion {
  // The motion on the sensor in mm for lights a unit to the right and up (tangents, offset_direction), through the same
  // point of whatever bounds the ghost: at the ray in the middle of the pupil, and at most twice that of the border's
  // fastest line.
  LinearMap shift_mm = kZeroMap;
  LinearMap spread_mm = kZeroMap;  // image, in sensor mm, of the unit circle: an ellipse as large as the ghost
  Vec2 centroid_mm;  // of the light
  double flux_mm2 = 0.0;  // times the light's irradiance; 0: no ray gets through, or nearly does
  bool is_open = false;
  double outside = 0.0;  // if not open: excess of the least blocked ray over what blocks it
  // The relative change of the pupil's area for lights a unit to the right and up.
  Vec2 area_rate;
  std::vector<GhostLine> lines;
};

// At the wavelength of the steps. windows: those of the light.
[[nodiscard]] GhostMotion ghost_motion(const LensSteps& steps, Ghost ghost, const LightSource& source,
                                       const LightWindows& windows);

}  // namespace contrejour::inline internal::area
