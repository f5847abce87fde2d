// A light as renderers take it: at which wavelengths it is drawn, and by what factor flux becomes pixel values.
#pragma once

#include <vector>

#include "contrejour/colour.h"
#include "contrejour/light_source.h"

namespace contrejour {

// A ghost, a light and a wavelength: the unit of rendering work.
struct PlannedPass {
  double lambda_nm = 550;
  // Pixel value per mm^2 of flux (E0 = 1, LightSource's flux included) that a ghost path puts into the pixel:
  // gain[c] = V[c] * w[c] / sum over bands of w[c] * Phi, times GhostOptions::edge_gain; looks come on top.
  Rgb gain{};
  double spread_nm = 0;  // root mean square, of the wavelengths it stands for about its own
};

struct PlannedLight {
  LightSource source;
  std::vector<PlannedPass> passes;  // by rising wavelength
};

}  // namespace contrejour
