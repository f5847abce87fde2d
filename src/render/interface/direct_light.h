// What a light's own image is, in the units that ghosts are measured against: docs/physics/radiometry.md.
#pragma once

#include <span>

#include "contrejour/colour.h"
#include "contrejour/frame.h"
#include "contrejour/ghost.h"

namespace contrejour {

// Where a light is measured: outside the frame at the nearest point of the frame's edge on the way to its centre.
[[nodiscard]] Vec3 measured_direction(const LensState& lens, const Frame& frame, Vec3 direction);

// Sum over the bands of w[c] * Phi, mm^2 at E0 = 1, from each band's direct flux in the measured direction. A light
// that does not get through there is measured on the axis; meters[k] is made for bands[k].
[[nodiscard]] Rgb direct_light(std::span<const SpectralBand> bands, std::span<const GhostMeter> meters,
                               std::span<const double> flux_mm2);

}  // namespace contrejour
