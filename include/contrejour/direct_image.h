// Where a light's own image counts as that which its value is of: docs/physics/radiometry.md, "Relative to the direct
// image". Thread-safety: a pure function.
#pragma once

#include "contrejour/frame.h"
#include "contrejour/lens.h"
#include "contrejour/light_source.h"

namespace contrejour {

// The light, where its image is in the frame; else one at its distance whose image is at the nearest point of the
// frame's edge on the way to the centre. Its direction is not a number where none lands there.
[[nodiscard]] LightSource measured_source(const LensState& lens, const Frame& frame, const LightSource& light);

}  // namespace contrejour
