// How finely a light is cut for each of its ghosts: one that only moves needs no pieces, one whose light gathers in
// lines, or that rims cut down differently as the light moves, needs many.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/area/ghost_blur.h"

namespace contrejour::area {

// A ghost of a light with a size.
struct GhostOfArea {
  std::size_t light = 0, ghost = 0;  // in the plan
  GhostMotion motion;  // of the light's middle,
  GhostBlur blur;      // for all of it
  // Those of the pieces of the light cut in two across, where that is looked at.
  std::vector<GhostMotion> part_motions;
  std::vector<GhostBlur> part_blurs;
  // If the light stays whole: errors squared and summed over the frame, in squares of the peak, and of the flux.
  double squares = 0.0, flux_off = 0.0;
  int across = 1;  // pieces of the light
};

// What a frame may be wrong by, and what that is measured against.
struct AreaBudget {
  double peak = 0.0;
  double squares = 0.0;  // summed over the frame, in squares of the peak
  double flux = 0.0;     // of all ghosts
};

// Whether the ghost may be so unlike what its middle says that its parts are to be looked at.
[[nodiscard]] bool may_need_parts(const GhostOfArea& ghost, const LightPiece& whole, const AreaBudget& budget);

// Sets `squares` and `flux_off`. parts: of the light cut in two across.
void foresee_errors(GhostOfArea& ghost, const LightPiece& whole, std::span<const LightPiece> parts, double peak);

// Sets `across` of all, so that errors together are within the budget with the fewest pieces.
void choose_pieces(std::span<GhostOfArea> ghosts, const AreaBudget& budget);

}  // namespace contrejour::area
