// Ghosts of a piece of a light that are blurred alike: drawn together, once, with as few pixels as the blur allows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/frame.h"
#include "render/area/ghost_blur.h"

namespace contrejour::area {

// A ghost of a piece of a light, with the level of the picture that it may be drawn in (layers.h).
struct PieceGhost {
  const GhostBlur* blur = nullptr;
  int level = 0;
};

struct BlurClass {
  bool is_sharp = false;  // blurred by less than shows: drawn as they are
  int level = 0;          // of the picture they are drawn in
  LinearMap px_from_tangents;  // in pixels of that level
  std::vector<std::size_t> ghosts;  // of those given, rising
};

struct BlurClasses {
  std::vector<BlurClass> classes;
  double squares = 0.0;  // what sharing makes wrong, squared and summed over the frame, in squares of the peak
};

// allowed_squares: what a ghost may be wrong by to spare a picture as costly as one of all of the frame's pixels.
[[nodiscard]] BlurClasses blur_classes(std::span<const PieceGhost> ghosts, const LightPiece& piece, const Frame& frame,
                                       double peak, double allowed_squares);

}  // namespace contrejour::area
