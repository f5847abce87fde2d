// Ghosts of a piece of a light that are blurred alike: drawn together, once, with as few pixels as the blur allows.
#pragma once

#include <span>
#include <vector>

#include "contrejour/frame.h"
#include "render/area/ghost_motion.h"
#include "render/area/light_pieces.h"

namespace contrejour::area {

struct BlurClass {
  bool is_sharp = false;  // blurred by less than shows: drawn as they are
  int level = 0;          // of the picture they are drawn in (layers.h)
  LinearMap px_from_tangents;  // in pixels of that level
  double peak = 0.0;  // irradiance over the light's that the whole picture's brightest parts reach
  // That over the brightest place of these ghosts before they are blurred: where it is more than 1, errors may be so
  // much larger in proportion.
  double room = 1.0;
  std::vector<Ghost> ghosts;
};

// motions: one for each ghost.
// allowed_squares: what the picture may be wrong by, squared and summed over the frame, in squares of the peak.
[[nodiscard]] std::vector<BlurClass> blur_classes(std::span<const Ghost> ghosts, std::span<const GhostMotion> motions,
                                                  const LightPiece& piece, const Frame& frame, double allowed_squares);

}  // namespace contrejour::area
