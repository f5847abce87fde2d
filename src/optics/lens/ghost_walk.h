// SPDX-License-Identifier: Apache-2.0
// The order in which a ghost's light meets the surfaces of a lens.
#pragma once

#include <array>
#include <cstddef>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Calls pass(surface, direction) where light is transmitted, the stop included, and reflect(surface, direction, order)
// where it is reflected. Surfaces count from 0; direction: +1 or -1, along the axis as light arrives. order: of
// diffraction, at the first reflection. There is no call for the sensor at the end of the path.
template <class Pass, class Reflect>
void walk_surfaces(const LensState& lens, const Ghost& ghost, const Pass& pass, const Reflect& reflect) {
  const int last = static_cast<int>(lens.surfaces.size()) - 1;
  int behind = -1;  // the surface that the light comes from, forward
  const auto pass_forward = [&](int to) {
    for (int k = behind + 1; k <= to; ++k)
      if (lens.surfaces[static_cast<std::size_t>(k)].kind != SurfaceKind::Sensor) pass(k, +1);
  };
  const auto there_and_back = [&](int far, int near, std::array<int, 2> order) {
    pass_forward(far - 1);
    reflect(far, +1, order);
    for (int k = far - 1; k > near; --k) pass(k, -1);
    reflect(near, -1, std::array<int, 2>{0, 0});
    behind = near;
  };
  there_and_back(ghost.j - 1, ghost.i - 1, ghost.order);
  if (ghost.reflects_four_times()) there_and_back(ghost.l - 1, ghost.k - 1, {0, 0});
  pass_forward(last);
}

}  // namespace contrejour::inline internal
