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

// A combination of unknowns that the ghosts leave open: reflectances may change by exp(t * direction) for any t.
using OpenDirection = Eigen::VectorXd;

struct ReflectanceFit {
  Eigen::VectorXd x;      // logarithms; as expected along open directions
  Eigen::VectorXd error;  // standard errors; for unknowns that are left open: of the prior
  int rank = 0;
  std::vector<OpenDirection> open;  // unit vectors
};

struct ReflectanceOptions {
  double prior = 1.5;         // standard error of the expected x: a factor of 4.5
  double most_error = 0.25;   // of x along a direction, above which the ghosts leave it open
};

// Measured energies with their standard errors, and the x that are expected before anything is measured -> the linear
// problem in logarithms, robust, with its rank by singular values.
[[nodiscard]] ReflectanceFit fit_logarithms(std::span<const GhostSurfaces> ghosts, const Eigen::VectorXd& ratio,
                                            const Eigen::VectorXd& error, const Eigen::VectorXd& expected,
                                            const ReflectanceOptions& options);

}  // namespace contrejour::inline internal
