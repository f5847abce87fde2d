// SPDX-License-Identifier: Apache-2.0
// The footprint of a ghost in the picture by traced rays: a grid over the part of the entrance plane whose rays get
// through, as polygons on the sensor. Cells that the border of the pupil crosses are cut there, by linear interpolation
// of how far the rays at their corners are blocked. Accuracy: borders to a small part of a cell, which is a sixteenth
// of the ghost's pupil; corners of the iris are cut off by as much. Thread-safety: plain values, pure functions.
#pragma once

#include <array>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "contrejour/ghost_figures.h"
#include "contrejour/light.h"

namespace contrejour::studio {

struct GhostFootprint {
  Ghost ghost;
  std::vector<std::vector<Vec2>> cells_px;  // polygons in the frame; empty: no ray of the grid gets through
  std::vector<std::array<Vec2, 2>> border_px;  // pieces of the outline

  // Whether a cell contains the point, or it is nearer to the ghost than this.
  [[nodiscard]] bool contains(Vec2 point_px, double reach_px) const;
};

[[nodiscard]] GhostFootprint footprint_of(const LensState& lens, const Ghost& ghost, const Light& light,
                                          const Frame& frame);

// The number of ghosts, from the first on, that are traced: it takes no longer than a user notices.
inline constexpr std::size_t kMostFootprints = 40;
[[nodiscard]] std::vector<GhostFootprint> footprints_of(const LensState& lens, const std::vector<GhostFigures>& figures,
                                                        const Light& light, const Frame& frame, const Context& context);

}  // namespace contrejour::studio
