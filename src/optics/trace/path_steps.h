// The steps of ways through a lens, one surface after the other: what paths for single rays and for packets share.
#pragma once

#include <array>
#include <optional>

#include "contrejour/trace.h"
#include "optics/lens/ghost_walk.h"

namespace contrejour {

// Adds the steps at a surface, 0-based, at the path's wavelength: rims of its own first, where it has such.
void add_steps(OpticalPath& path, const LensState& lens, int surface, int direction, PathEvent event);

// What a sensor's grating does to the light that it reflects into one order (PathStep); none where there is no grating.
struct GratingTurn {
  Vec2 kick;
  double share = 1;
};
[[nodiscard]] std::optional<GratingTurn> grating_turn(const LensState& lens, int surface, std::array<int, 2> order,
                                                      double lambda_nm);

// A ghost's way: calls `visit(surface, direction, event)` at every surface in turn, and where light that goes forward
// is reflected `turn(surface, order)` after that.
template <class Visit, class Turn>
void walk_ghost(const LensState& lens, const Ghost& ghost, const Visit& visit, const Turn& turn) {
  walk_surfaces(
      lens, ghost, [&](int surface, int direction) { visit(surface, direction, PathEvent::Refract); },
      [&](int surface, int direction, std::array<int, 2> order) {
        visit(surface, direction, PathEvent::Reflect);
        if (direction > 0) turn(surface, order);
      });
}

}  // namespace contrejour
