// The steps of ways through a lens, one surface after the other: what paths for single rays and for packets share.
#pragma once

#include <array>
#include <optional>

#include "contrejour/trace.h"

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
  const int last = static_cast<int>(lens.surfaces.size()) - 1;
  int behind = -1;  // the surface that the light comes from, forward
  const auto pass_forward = [&](int to) {
    for (int k = behind + 1; k <= to; ++k)
      if (lens.surfaces[static_cast<std::size_t>(k)].kind != SurfaceKind::Sensor) visit(k, +1, PathEvent::Refract);
  };
  const auto there_and_back = [&](int far, int near, std::array<int, 2> order) {
    pass_forward(far - 1);
    visit(far, +1, PathEvent::Reflect);
    turn(far, order);
    for (int k = far - 1; k > near; --k) visit(k, -1, PathEvent::Refract);
    visit(near, -1, PathEvent::Reflect);
    behind = near;
  };
  there_and_back(ghost.j - 1, ghost.i - 1, ghost.order);
  if (ghost.reflects_four_times()) there_and_back(ghost.l - 1, ghost.k - 1, {0, 0});
  pass_forward(last);
}

}  // namespace contrejour
