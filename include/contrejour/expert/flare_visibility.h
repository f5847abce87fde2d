// SPDX-License-Identifier: Apache-2.0
// Measures how visible a flare is on its photograph. Thread-safety: pure functions.
#pragma once

#include <optional>

#include "contrejour/expert/light_detection.h"
#include "contrejour/export.h"
#include "contrejour/image.h"

namespace contrejour {

struct FlareVisibility {
  double brightest = 0;  // the flare's luminance at its 99.5th percentile, without the lights' pixels
  double relative_to_picture = 0;  // the 99.5th percentile of the flare's luminance over the picture's
  std::optional<double> stops_to_obvious;  // gain in stops at which the flare is obvious; nullopt: there is no flare
};

// rgb: the picture without the flare; found: where its lights are (without effect if it is of another size). A
// hundredth of white is added to the picture's luminance, because the ratio to black would be infinite.
[[nodiscard]] CONTREJOUR_API FlareVisibility visibility_of(const Image& rgb, const Image& flare, const Detection& found,
                                                           ColourSpace space);

}  // namespace contrejour
