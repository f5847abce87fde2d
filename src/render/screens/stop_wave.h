// The wave of a path's light where it crosses the stop for the last time, to the first order: what its edge's shadow
// looks like on the sensor. Earlier crossings stay sharp: their rims are blurred by what comes after them much as the
// last one's is, but a pattern of a pattern has no closed form, and such ghosts cross the stop three times, faintly.
// A lens without axial symmetry has two of all this; the mean stands for both (docs/physics/surfaces.md).
// Source: Collins 1970 eq. 12 (contrejour/fresnel.h). Thread-safety: pure functions.
#pragma once

#include <limits>
#include <vector>

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

// How the sensor sees a plane that the light crosses on its way, its beam narrowed to a point of it.
struct PlaneWave {
  double distance_mm = 0.0;  // effective: |B / (n (A + B c))|, infinite where the plane is the sensor's far field
  double magnification = 1.0;  // of distances in the plane, on the sensor: |A + B c|
};

// At each crossing of the stop, in turn; of the first surface's vertex. Two sections: means of both.
[[nodiscard]] std::vector<PlaneWave> stop_crossing_waves(const OpticalPath& path, double light_distance_mm);
[[nodiscard]] PlaneWave front_wave(const OpticalPath& path, double light_distance_mm);

}  // namespace contrejour::screens
