// SPDX-License-Identifier: Apache-2.0
// Pictures of detected lights: three channels, scene-linear, of the size of the photograph in which they were
// detected. Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/colour.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/export.h"
#include "contrejour/image.h"

namespace contrejour {

// Each pixel times its weight in its light, and 0 elsewhere.
[[nodiscard]] CONTREJOUR_API Image pixels_of_lights(const Image& rgb, const Detection& found);

// A false-colour preview: the picture in dim grey, and each light's pixels in a colour of its own. Merged areas have
// the same colour.
[[nodiscard]] CONTREJOUR_API Image false_colour_lights(const Image& rgb, const Detection& found, ColourSpace space);

}  // namespace contrejour
