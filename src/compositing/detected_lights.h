// SPDX-License-Identifier: Apache-2.0
// Detected areas of a photograph -> lights in front of the lens. Thread-safety: a pure function.
#pragma once

#include <vector>

#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/pixel_grid.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"

namespace contrejour {

// One light for each detected light, in the same order: the direction whose image is the area's centroid, the area's
// flux times the values' gain, and with --light-shape the extent of its pixels.
[[nodiscard]] std::vector<Light> lights_of(const Detection& found, const Spectrum& spectrum, const Image& rgb,
                                           const PixelGrid& grid, const LensState& lens, const params::Values& values);

}  // namespace contrejour
