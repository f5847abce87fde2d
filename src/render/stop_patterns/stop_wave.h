// SPDX-License-Identifier: Apache-2.0
// First-order properties of the wave of a path's light at its last crossing of the stop: they determine the shadow of
// the stop's edge on the sensor. Earlier crossings stay sharp: their rims are blurred much as the last one's is, but a
// pattern of a pattern has no closed form, and such ghosts, which cross the stop three times, are faint. A lens without
// axial symmetry has two such waves, of which the mean is used (docs/physics/surfaces.md).
// Source: Collins 1970 eq. 12 (contrejour/expert/fresnel.h). Thread-safety: pure functions.
#pragma once

#include <limits>
#include <vector>

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal::stop_patterns {

struct StopWave {
  double fresnel_number = std::numeric_limits<double>::infinity();  // a^2 (A + B c) / (lambda B)
  double footprint = 1.0;  // radius of the stop's image on the sensor over the stop's own: |A + B c|
};

// light_distance_mm: from the first surface to a light on the axis, positive in front of the lens. Field dependence:
// the values on the axis are used for the whole field. A path that does not cross the stop has an infinite Fresnel
// number.
[[nodiscard]] StopWave stop_wave(const OpticalPath& path,
                                 double light_distance_mm = std::numeric_limits<double>::infinity());

// The wave at a plane that the light crosses, as if the beam were narrowed to one point of it.
struct PlaneWave {
  double distance_mm = 0.0;  // effective: |B / (n (A + B c))|, infinite where the plane is the sensor's far field
  double magnification = 1.0;  // of distances in the plane, on the sensor: |A + B c|
};

// At each crossing of the stop, in order; front_wave(): at the first surface's vertex. Without axial symmetry the mean
// of both sections.
[[nodiscard]] std::vector<PlaneWave> stop_crossing_waves(const OpticalPath& path, double light_distance_mm);
[[nodiscard]] PlaneWave front_wave(const OpticalPath& path, double light_distance_mm);

}  // namespace contrejour::inline internal::stop_patterns
