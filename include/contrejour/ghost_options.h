// What an artist changes about ghosts: gains, colours and places. The defaults are physically right.
// Gains are 0 and more, 1 is physically right; so are colours, per channel. Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <vector>

#include "contrejour/colour.h"
#include "contrejour/ghost_id.h"
#include "contrejour/vec.h"

namespace contrejour {

struct GhostAdjustment {
  Ghost ghost;
  double gain = 1.0;
  Rgb colour{1, 1, 1};
  Vec2 offset{};  // in the picture, to the right and up, of the frame's height
  int surface = 0;  // 1-based, in place of a ghost: all ghosts that reflect there
};

// A colour that ghosts are multiplied by, over where they lie: 1 at the light's image, 0 in the frame's middle, -1
// opposite the light (first order: through the middle of the stop). Between stops it goes over evenly, beyond the first
// and the last it stays.
struct GhostRampStop {
  double place = 0.0;
  Rgb colour{1, 1, 1};
};

struct GhostOptions {
  double gain = 1.0;  // of all ghosts
  double edge_gain = 1.0;  // and this when the light is at the frame's corner, in proportion nearer to the middle
  std::vector<GhostAdjustment> adjustments;  // gains and colours of one ghost multiply, its offsets add up
  std::vector<GhostRampStop> ramp;  // places rising
  // hullin2011 4.2, imperfect symmetry: each ghost is set off by its own random way, normally distributed with this
  // root mean square, of the frame's height.
  double scatter = 0.0;
  std::uint32_t scatter_seed = 0;
};

}  // namespace contrejour
