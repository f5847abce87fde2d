// SPDX-License-Identifier: Apache-2.0
// The direct images of the lights, which every method adds to the ghosts in the same way: their starbursts, by
// diffraction, and their glare, by scattering (docs/physics/diffraction.md).
// Thread-safety: plain values.
#pragma once

#include <memory>
#include <vector>

#include "contrejour/image.h"
#include "contrejour/light.h"

namespace contrejour {

// The starburst of a light that gets through in full sums to the light's value over an unlimited picture.
struct StarburstOptions {
  bool on = false;
  double gain = 1.0;  // at least 0; 1 is physically right
  // For a photograph that contains the lights' own images already: the fraction, 0 to 1, of each pixel in which
  // starburst and glare are left out, as one channel of the frame's size. Null: nothing is left out.
  std::shared_ptr<const Image> left_out = nullptr;
  // The lights whose starbursts and glare are drawn, if they differ from those of the ghosts: lights that were merged
  // for the ghosts keep separate images. Null: the lights of the ghosts.
  std::shared_ptr<const std::vector<Light>> lights = nullptr;
};

// Light that polish, dust and edges scatter around each light's own image: over angles theta as (1 + (theta /
// width)^2)^-1.5.
struct GlareOptions {
  double fraction = 0.0;  // fraction of the light's value, 0 to 1, over an unlimited picture; 0: none
  double width_rad = 0.0175;
};

}  // namespace contrejour
