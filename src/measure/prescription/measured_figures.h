// SPDX-License-Identifier: Apache-2.0
// How far ghosts in the pictures are from ghosts drawn through a lens: displacements of their middles and changes of
// their sizes, with weights. All ghosts of a station are measured at once, whether they overlap or not.
// Source: docs/physics/measured-flare.md, "Places and sizes of ghosts".
// Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "measure/prescription/ghost_energies.h"
#include "measure/prescription/traced_figures.h"

namespace contrejour::inline internal {

// Four figures a ghost, as traced_figures.h orders them: measured minus drawn.
struct StationFigures {
  Eigen::VectorXd off;
  Eigen::MatrixXd weight;   // inverse covariance
  double count = 0;  // of the figures that the picture shows: one of which it says half counts a half
};

struct MeasuredFigures {
  std::vector<StationFigures> by_station;
  [[nodiscard]] double cost() const;  // half the weighted sum of squares
  // Weighted RMS of the middles' displacements.
  [[nodiscard]] double rms_px() const;
};

// Weights of pixels are those of the first drawing, if they are given; else they are made.
[[nodiscard]] Result<MeasuredFigures> measured_figures(const DrawnSweep& drawn, Vec2 centre_px,
                                                       std::vector<Image>& weights, const Context& context);

}  // namespace contrejour::inline internal
