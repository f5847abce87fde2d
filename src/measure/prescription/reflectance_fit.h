// SPDX-License-Identifier: Apache-2.0
// Reflectances of surfaces from energies of ghosts: log E_ij = log E0_ij + x_i + x_j, with x the logarithm of a
// surface's reflectance over that with which E0 was computed.
// Source: docs/physics/measured-flare.md, "Reflectances from energies".
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace contrejour::inline internal {

// The unknowns that a ghost's energy depends on: -1 for a surface whose reflectance is known.
struct GhostSurfaces {
  std::array<int, 2> unknown{-1, -1};
};

// Energies of ghosts over those expected, in one channel: the cost of ratios a is (yy - 2 b a + a^T A a) / 2.
struct EnergyEquations {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  double yy = 0;
};

// A combination of unknowns that the ghosts leave open: reflectances may change by exp(t * direction) for any t.
using OpenDirection = Eigen::VectorXd;

struct ReflectanceFit {
  Eigen::VectorXd x;      // logarithms; 0 along open directions
  Eigen::VectorXd error;  // standard errors; for unknowns that are left open: of the prior
  int rank = 0;
  std::vector<OpenDirection> open;  // unit vectors
};

struct ReflectanceOptions {
  double prior = 1.5;         // standard error of x before anything is measured: a factor of 4.5
  double most_error = 0.25;   // of x along a direction, above which the ghosts leave it open
};

// Measured energies with their standard errors -> the linear problem in logarithms, robust, with its rank by singular
// values.
[[nodiscard]] ReflectanceFit fit_logarithms(std::span<const GhostSurfaces> ghosts, const Eigen::VectorXd& ratio,
                                            const Eigen::VectorXd& error, int unknowns,
                                            const ReflectanceOptions& options);

// The x of the least cost, from a start: pictures of ghosts that overlap are weighted together, and ghosts too dim to
// have a logarithm count as well.
[[nodiscard]] Eigen::VectorXd refined_logarithms(std::span<const GhostSurfaces> ghosts, const EnergyEquations& energies,
                                                 const Eigen::VectorXd& start, const ReflectanceOptions& options);

}  // namespace contrejour::inline internal
