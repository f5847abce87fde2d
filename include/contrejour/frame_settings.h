// SPDX-License-Identifier: Apache-2.0
// The contents of a frame, whichever method renders it: its pixels, ghosts, wavelengths and effects.
// render() refuses values out of range. Thread-safety: plain values.
#pragma once

#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/ghost_options.h"
#include "contrejour/expert/ringing_options.h"
#include "contrejour/expert/starburst_options.h"
#include "contrejour/frame.h"

namespace contrejour {

inline constexpr int kAutoWavelengths = 0;

struct FrameSettings {
  Frame frame;
  GhostScope scope = GhostScope::All;
  Reflections reflections = Reflections::Two;
  GhostSelection selection = SelectAll{};
  // The number of bands of the visible spectrum. kAutoWavelengths: for each ghost as many as its dispersion and the
  // coatings require, 32 at most (docs/physics/colour.md). Each channel's flux is that of 96 bands to 2 per cent, by
  // any method.
  int wavelengths = kAutoWavelengths;
  ColourSpace colour_space = ColourSpace::Rec709;
  std::vector<double> lambda_nm;  // instead of bands: these wavelengths, equal weights, for tests and tables

  // Extended lights: the RMS error that blurring the ghosts of points may add, relative to the frame's peak, by any
  // method; 1e-4 to 0.1. AdaptiveOptions::error limits the error of the method itself.
  double area_error = 0.003;
  StarburstOptions starburst;
  GlareOptions glare;
  GhostOptions ghosts;
  RingingOptions ringing;
};

}  // namespace contrejour
