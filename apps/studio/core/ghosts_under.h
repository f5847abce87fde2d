// SPDX-License-Identifier: Apache-2.0
// The ghosts that cover a point of the picture, by the ellipses that their figures state: close to the truth for the
// discs and polygons that most ghosts are, and too much for crescents. Thread-safety: pure.
#pragma once

#include <vector>

#include "contrejour/ghost_figures.h"

namespace contrejour::studio {

// Indices into the figures, by the mean irradiance there, the brightest first.
[[nodiscard]] std::vector<std::size_t> ghosts_under(const std::vector<GhostFigures>& figures, Vec2 point_px);

}  // namespace contrejour::studio
