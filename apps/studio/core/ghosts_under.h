// SPDX-License-Identifier: Apache-2.0
// The ghosts that cover a point of the picture: by their traced footprints where there are some, else by the ellipses
// that their figures state, which are too much for crescents. Thread-safety: pure.
#pragma once

#include <span>
#include <vector>

#include "contrejour/ghost_figures.h"
#include "studio/core/ghost_footprint.h"

namespace contrejour::studio {

// Indices into the figures, by the irradiance at the point, the brightest first. footprints: one for each of the
// figures, or none.
[[nodiscard]] std::vector<std::size_t> ghosts_under(const std::vector<GhostFigures>& figures, Vec2 point_px,
                                                    std::span<const GhostFootprint> footprints = {});

}  // namespace contrejour::studio
