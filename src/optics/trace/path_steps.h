// SPDX-License-Identifier: Apache-2.0
// The steps of optical paths through a lens, surface by surface: common code of paths for single rays and for packets.
#pragma once

#include <array>
#include <optional>

#include "contrejour/expert/trace.h"
#include "optics/lens/ghost_walk.h"

namespace contrejour::inline internal {

// Adds the steps at a surface, 0-based, at the path's wavelength, with the surface's own rims first.
void add_steps(OpticalPath& path, const LensState& lens, int surface, int direction, PathEvent event);

// The effect of a sensor's grating on light reflected into one order (PathStep); the default is no grating.
struct GratingDeflection {
  Vec2 grating_shift;
  double efficiency = 1;
};
[[nodiscard]] std::optional<GratingDeflection> grating_deflection(const LensState& lens, int surface,
                                                                  std::array<int, 2> order, double lambda_nm);

// Follows a ghost's path: calls `visit(surface, direction, event)` at every surface in order, and then
// `deflect(surface, order)` where light that travels forward is reflected.
template <class Visit, class Deflect>
void walk_ghost(const LensState& lens, const Ghost& ghost, const Visit& visit, const Deflect& deflection) {
  walk_surfaces(
      lens, ghost, [&](int surface, int direction) { visit(surface, direction, PathEvent::Refract); },
      [&](int surface, int direction, std::array<int, 2> order) {
        visit(surface, direction, PathEvent::Reflect);
        if (direction > 0) deflection(surface, order);
      });
}

}  // namespace contrejour::inline internal
