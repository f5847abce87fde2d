// How plainly a flare shows on its photograph. Thread-safety: pure functions.
#pragma once

#include <optional>

#include "contrejour/image.h"
#include "contrejour/light_detection.h"

namespace contrejour {

struct FlareVisibility {
  double brightest = 0;  // luminance of the flare that its brightest two hundredth exceeds, the lights' pixels aside
  double over_picture = 0;  // likewise, of the flare over the picture beneath it
  std::optional<double> stops_to_plain;  // how much brighter it would have to be to be plain; none: there is no flare
};

// The picture without the flare, the flare, and where lights are (none of another size: nowhere). Over black, which a
// flare of any brightness exceeds, what counts is a hundredth of white.
[[nodiscard]] FlareVisibility visibility_of(const Image& rgb, const Image& flare, const Detection& found,
                                            ColourSpace space);

}  // namespace contrejour
