// Pictures of what was taken for lights: three channels, scene-linear, of the size of the photograph in which they were
// detected. Thread-safety: pure functions.
#pragma once

#include "contrejour/colour.h"
#include "contrejour/image.h"
#include "contrejour/light_detection.h"

namespace contrejour {

// Each pixel as it counts to its light, and 0 elsewhere.
[[nodiscard]] Image pixels_of_lights(const Image& rgb, const Detection& found);

// To look at: the picture in dim grey, and each light's pixels in a colour of its own; merged areas have one together.
[[nodiscard]] Image map_of_lights(const Image& rgb, const Detection& found, ColourSpace space);

}  // namespace contrejour
