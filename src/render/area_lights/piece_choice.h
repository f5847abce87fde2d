// SPDX-License-Identifier: Apache-2.0
// Chooses how finely a light is divided for each of its ghosts. A ghost that only moves needs no pieces; one with
// caustics, or one that rims clip differently as the light moves, needs many.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "render/area_lights/ghost_blur.h"

namespace contrejour::inline internal::area {

inline constexpr std::array kAcross{1, 2, 3, 4, 6, 8, 12};  // pieces across of the divisions to choose from

// A ghost of a light with a size.
struct GhostOfArea {
  std::size_t light = 0, ghost = 0;  // in the plan
  GhostMotion motion;  // for the middle of the light
  GhostBlur blur;      // for the whole light
  // The same for the pieces of the light divided in two across, if they are examined.
  std::vector<GhostMotion> part_motions;
  std::vector<GhostBlur> part_blurs;
  double doubt = 0.0;  // 0 to 1: the weight of the errors that the parts show
  // The errors if the light stays undivided: squared, summed over the frame, in squares of the peak; and of the flux.
  double squares = 0.0, flux_error = 0.0;
  // The part of the ghost's light that is drawn with each of kAcross; together 1, and mostly one or two of them.
  std::array<double, kAcross.size()> parts{1.0};
};

// The errors that a frame may make, and what they are relative to.
struct AreaBudget {
  double peak = 0.0;
  double squares = 0.0;  // summed over the frame, in squares of the peak
  double flux = 0.0;  // of all ghosts
  double spot_squares = 0.0;  // of one spot, as `squares` (spot_level())
};

// To what degree the ghost may differ from what the light's middle predicts, 0 to 1: above 0 the light's parts must be
// examined. It rises steadily, so that no ghost is divided at once because its parts are examined in one frame and not
// in the one before.
[[nodiscard]] double doubt_about(const GhostOfArea& ghost, const LightPiece& whole, const AreaBudget& budget);

// Predicts `squares` and `flux_error`. parts: the pieces of the light divided in two across.
void foresee_errors(GhostOfArea& ghost, const LightPiece& whole, std::span<const LightPiece> parts,
                    const AreaBudget& budget);

// Sets `parts` of all ghosts, so that together they stay within the budget with about the fewest pieces. A step that is
// hardly worth making is made in part: so a ghost fades from one division into the next as its light moves, and neither
// jumps nor makes others jump. The next one may be much finer, if those between are worse than both.
void choose_pieces(std::span<GhostOfArea> ghosts, const AreaBudget& budget);

}  // namespace contrejour::inline internal::area
