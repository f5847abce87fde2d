// SPDX-License-Identifier: Apache-2.0
// Middles and sizes of ghosts at all stations of a sweep, by exact rays through a lens, and their derivatives.
// Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "measure/prescription/lens_numbers.h"
#include "measure/prescription/lens_stations.h"

namespace contrejour::inline internal {

struct GhostFigure {
  Vec2 middle_px, size_px;  // of the light that arrives; sides of the box around it
  bool is_there = false;
};

// In the order of stations, and of ghosts within each.
using SweepFigures = std::vector<GhostFigure>;

[[nodiscard]] Result<SweepFigures> traced_figures(const LensStations& stations, const LensState& lens, Vec2 centre_px,
                                                  const std::vector<Ghost>& ghosts, const Context& context);

inline constexpr Eigen::Index kFigures = 4;  // of a ghost: middle x, y in pixels; relative size in x, y

// A matrix for each station: of the ghosts' figures (four each) by the numbers of the lens and by the centre's x and y
// in pixels, which are the last two columns. Central differences.
[[nodiscard]] Result<std::vector<Eigen::MatrixXd>> figure_derivatives(const LensStations& stations,
                                                                      const AdjustableLens& lens,
                                                                      const Eigen::VectorXd& unknowns,
                                                                      const std::vector<Ghost>& ghosts,
                                                                      const Context& context);

// The unknowns are the numbers of the lens, then the shift of the centre from the stations' in their pixels.
[[nodiscard]] Vec2 centre_of(const LensStations& stations, const Eigen::VectorXd& unknowns);
[[nodiscard]] Result<LensState> lens_of(const AdjustableLens& lens, const Eigen::VectorXd& unknowns);

}  // namespace contrejour::inline internal
