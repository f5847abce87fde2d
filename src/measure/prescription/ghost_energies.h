// SPDX-License-Identifier: Apache-2.0
// Energies of ghosts in the pictures of a sweep, over those of a lens drawn through the same stations.
// Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "measure/prescription/station_matrix.h"

namespace contrejour::inline internal {

// Energies of ghosts over those expected, in one channel: the cost of ratios a is (yy - 2 b a + a^T A a) / 2.
struct EnergyEquations {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  double yy = 0;
};

// For each station and channel: the equations of the ghosts' ratios and of the halo, which is the same at all stations
// but for small deviations. The deviations, and all other ghosts together, are at their best.
struct SweepEnergies {
  std::vector<StationMatrix> by_station;
  Eigen::Index ghosts = 0;

  // The sum for the ghosts in one channel, without one station (-1: with all).
  [[nodiscard]] EnergyEquations sum(std::size_t channel, std::ptrdiff_t without = -1) const;
  [[nodiscard]] double pixels(std::size_t channel) const;
};

struct DrawnSweep {
  const LensStations* stations = nullptr;
  LensState lens;
  std::vector<Ghost> ghosts;
  double model_error = 0.05;
};

[[nodiscard]] Result<SweepEnergies> sweep_energies(const DrawnSweep& drawn, const Context& context);

// The ghosts that are brightest in the pictures, at most `most` of them, the brightest first.
[[nodiscard]] Result<std::vector<Ghost>> visible_ghosts(const LensStations& stations, const LensState& lens, int most,
                                                        const Context& context);

}  // namespace contrejour::inline internal
