// SPDX-License-Identifier: Apache-2.0
// A light as renderers use it: the wavelengths at which it is drawn, and the factors from flux to pixel values.
#pragma once

#include <cstddef>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/light_source.h"

namespace contrejour::inline internal {

// How the gains of a pass change over the entrance plane: the other wavelengths that it represents meet the coatings at
// angles of their own. At the point p the gain of a channel is gain[c] + by_x[c] (p.x - middle.x) + by_y[c] (p.y -
// middle.y), in mm.
struct GainSlopes {
  Vec2 middle_mm;
  Rgb by_x{}, by_y{};
};

// One wavelength at which a ghost of a light is rendered, with its gains.
struct PlannedPass {
  double lambda_nm = 550;
  // The value that a ghost adds to a pixel per mm^2 of flux that falls on it (E0 = 1, LightSource's flux included):
  // gain[c] = V[c] * w[c] / sum over bands of w[c] * Phi, times GhostOptions::edge_gain. The ghosts' adjustments are
  // further factors.
  Rgb gain{};
  double spread_nm = 0;  // root mean square distance of the wavelengths it represents from its own
  GainSlopes slopes{};  // 0 unless it represents several passes (with_adaptive_passes); a method may ignore them
};

struct PlannedLight {
  LightSource source;
  std::vector<PlannedPass> passes;  // in order of wavelength
  std::size_t index = 0;  // of the frame's light that this is, or is a piece of
};

}  // namespace contrejour::inline internal
