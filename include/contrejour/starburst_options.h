// The image of each light itself, which every method adds after the ghosts in the same way: as diffraction spreads it,
// and as glare does (docs/physics/diffraction.md).
// Thread-safety: plain values.
#pragma once

#include <memory>
#include <vector>

#include "contrejour/image.h"
#include "contrejour/light.h"

namespace contrejour {

// A light that gets through in full sums to its value over an unlimited picture.
struct StarburstOptions {
  bool on = false;
  double gain = 1.0;  // 0 and more; 1 is physically right
  // Where a photograph holds the lights' own images already: the fraction from 0 to 1 of each pixel that is left out of
  // starburst and glare, one channel, as large as the frame. Null: nothing is left out.
  std::shared_ptr<const Image> left_out = nullptr;
  // Whose images are drawn, with starburst and glare, where these are not the lights that the ghosts are of: lights
  // that were merged for the ghosts' sake keep their images apart. Null: the same.
  std::shared_ptr<const std::vector<Light>> lights = nullptr;
};

// What polish, dust and edges scatter about each light's own image: over angles theta as (1 + (theta / width)^2)^-1.5.
struct GlareOptions {
  double share = 0.0;  // of the light's value, 0 to 1, over an unlimited picture; 0: none
  double width_rad = 0.0175;
};

}  // namespace contrejour
