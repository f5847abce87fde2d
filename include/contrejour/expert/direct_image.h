// SPDX-License-Identifier: Apache-2.0
// The source whose direct image a light's value refers to: docs/physics/radiometry.md, "Relative to the direct image".
// Thread-safety: a pure function.
#pragma once

#include "contrejour/expert/light_source.h"
#include "contrejour/export.h"
#include "contrejour/frame.h"
#include "contrejour/lens.h"

namespace contrejour {

// The light itself if its image lies in the frame; else a light at the same distance whose image lies where the line
// from the light's image to the centre crosses the frame's edge. Its direction is NaN if no light has its image there.
[[nodiscard]] CONTREJOUR_API LightSource measured_source(const LensState& lens, const Frame& frame,
                                                         const LightSource& light);

}  // namespace contrejour
