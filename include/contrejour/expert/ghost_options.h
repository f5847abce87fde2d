// SPDX-License-Identifier: Apache-2.0
// An artist's changes of ghosts: gains, colours and positions. The defaults are physically right.
// Gains, and colours per channel, are at least 0; 1 changes nothing. Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/vec.h"

namespace contrejour {

struct GhostAdjustment {
  Ghost ghost;
  double gain = 1.0;
  Rgb colour{1, 1, 1};
  Vec2 offset{};  // in the picture, to the right and up, in units of the frame's height
  int surface = 0;  // 1-based; if set, this applies to all ghosts that reflect there, and `ghost` is ignored
};

// A factor on the ghosts' colours by position: 1 at the light's image, 0 in the frame's middle, -1 opposite the light
// (to first order, by the ray through the middle of the stop). It is linear between ramp stops and constant beyond the
// first and the last.
struct GhostRampStop {
  double position = 0.0;
  Rgb colour{1, 1, 1};
};

struct GhostOptions {
  double gain = 1.0;  // for all ghosts
  double edge_gain = 1.0;  // factor for a light at the frame's corner; 1 at the middle, linear in the distance from it
  std::vector<GhostAdjustment> adjustments;  // gains and colours of one ghost multiply, its offsets add up
  std::vector<GhostRampStop> ramp;  // in order of position
  // hullin2011 4.2, imperfect symmetry: each ghost has its own random offset, normally distributed with this root mean
  // square, in units of the frame's height.
  double jitter = 0.0;
  std::uint32_t jitter_seed = 0;
};

}  // namespace contrejour
