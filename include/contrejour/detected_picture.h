// Pictures of detected lights: three channels, scene-linear, of the size of the photograph in which they were
// detected. Thread-safety: pure functions.
#pragma once

#include "contrejour/colour.h"
#include "contrejour/image.h"
#include "contrejour/light_detection.h"

namespace contrejour {

// Each pixel times its weight in its light, and 0 elsewhere.
[[nodiscard]] Image pixels_of_lights(const Image& rgb, const Detection& found);

// A preview: the picture in dim grey, and each light's pixels in a colour of its own; merged areas share one.
[[nodiscard]] Image map_of_lights(const Image& rgb, const Detection& found, ColourSpace space);

}  // namespace contrejour
