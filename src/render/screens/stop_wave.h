// The wave of a path's light where it crosses the stop for the last time, to the first order: what its edge's shadow
// looks like on the sensor. Earlier crossings stay sharp: their rims are blurred by what comes after them much as the
// last one's is, but a pattern of a pattern has no closed form, and such ghosts cross the stop three times, faintly.
// A lens without axial symmetry has two of all this; the mean stands for both (docs/physics/surfaces.md).
// Source: Collins 1970 eq. 12 (contrejour/fresnel.h). Thread-safety: pure functions.
#pragma once

#include <limits>

#include "contrejour/trace.h"

namespace contrejour::screens {

struct StopWave {
  double fresnel_number = std::numeric_limits<double>::infinity();  // a^2 (A + B c) / (lambda B)
  double footprint = 1.0;  // radius of the stop's image on the sensor over the stop's own: |A + B c|
};

// light_distance_mm: from the first surface to a light on the axis, positive in front of the lens. Fields: the axis's
// values hold for all of them. A path that does not cross the stop has no edge: an infinite Fresnel number.
[[nodiscard]] StopWave stop_wave(const OpticalPath& path,
                                 double light_distance_mm = std::numeric_limits<double>::infinity());

}  // namespace contrejour::screens
