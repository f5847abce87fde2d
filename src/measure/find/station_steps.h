// SPDX-License-Identifier: Apache-2.0
// How clearly all stations together show something that moves with the light, from how clearly each of them does.
// Thread-safety: pure functions.
#pragma once

#include <vector>

namespace contrejour::inline internal {

// A step of brightness at one station, in standard deviations.
struct StationStep {
  double s = 0, step = 0;
};

struct StationsContrast {
  double contrast = 0;         // of the best range of stations, not below 0
  double signed_contrast = 0;  // of all stations
  double first = 0, last = 0;  // the range's tangents
};

// The best range of stations from the axis outwards: the sum of the evidence of their steps over the root of their
// number. A ghost that the halo, the mask or a brighter ghost hides at some stations loses their part only.
[[nodiscard]] StationsContrast contrast_over_stations(std::vector<StationStep>& steps);

// The spread of what the pictures show where there is nothing: of all candidates, nearly all of which are nothing.
[[nodiscard]] double usual_contrast(std::vector<double> contrasts);

}  // namespace contrejour::inline internal
