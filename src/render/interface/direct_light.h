// What a light's own image is, in the units that ghosts are measured against: docs/physics/radiometry.md.
#pragma once

#include <span>

#include "contrejour/colour.h"
#include "contrejour/frame.h"
#include "contrejour/ghost.h"

namespace contrejour {

// Sum over the bands of w[c] * Phi, mm^2 at E0 = 1; meters[k] is made for bands[k]. A light outside the frame is
// measured at the nearest point of the frame's edge on the way to its centre; one whose light does not get
// through there, on the axis.
[[nodiscard]] Rgb direct_light(const LensState& lens, const Frame& frame, Vec3 direction,
                               std::span<const SpectralBand> bands, std::span<const GhostMeter> meters);

}  // namespace contrejour
