// SPDX-License-Identifier: Apache-2.0
// The footprint of a ghost in the picture by traced rays: a grid over the part of the entrance plane whose rays get
// through, as polygons on the sensor. Cells that the border of the pupil crosses are cut there, by linear interpolation
// of how far the rays at their corners are blocked, or by halving where a ray fails. Accuracy: borders to a small part
// of a cell, which is a sixteenth of the ghost's pupil; corners of the iris are cut off by as much. Thread-safety:
// plain values, pure functions.
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
  std::vector<double> cell_light;  // of each cell, the fraction of the ghost's light, at the design wavelength
  std::vector<std::array<Vec2, 2>> border_px;  // pieces of the outline

  // Whether a cell contains the point, or it is nearer to the ghost than this.
  [[nodiscard]] bool contains(Vec2 point_px, double reach_px) const;
  // The fraction of the ghost's light on a pixel at the point, as a mean over at least a disc of this radius.
  [[nodiscard]] double irradiance_at(Vec2 point_px, double radius_px) const;
};

[[nodiscard]] GhostFootprint footprint_of(const LensState& lens, const Ghost& ghost, const Light& light,
                                          const Frame& frame);

// Traces the first ghosts, and others with the highest peaks, as many as take no longer than a user notices. One for
// each of the figures; without cells if it was not traced.
inline constexpr std::size_t kFootprintsByFlux = 40, kFootprintsByPeak = 20;
[[nodiscard]] std::vector<GhostFootprint> footprints_of(const LensState& lens, const std::vector<GhostFigures>& figures,
                                                        const Light& light, const Frame& frame, const Context& context);

}  // namespace contrejour::studio
