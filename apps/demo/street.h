// SPDX-License-Identifier: Apache-2.0
// A small synthetic night street as a scene-linear picture: dark houses with lit windows, lamps, a car, a low and very
// bright moon, wet asphalt. It is made by formulas, the same on every machine up to rounding.
#pragma once

#include "contrejour/image.h"

namespace contrejour::demo {

struct StreetSettings {
  int width = 960, height = 540;
  double hfov_rad = 0.5;  // horizontal field of view of the camera
};

// Dark walls near 0.01, lit asphalt near 0.3, windows near 3, lamps near 900, headlights and the moon in the thousands.
[[nodiscard]] Image make_street(const StreetSettings& settings);

}  // namespace contrejour::demo
