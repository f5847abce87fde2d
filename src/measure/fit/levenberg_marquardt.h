// SPDX-License-Identifier: Apache-2.0
// Nonlinear least squares from normal equations, which problems with millions of residuals can form and Jacobians could
// not. Source: Levenberg 1944, Marquardt 1963; damping by Nielsen 1999.
// Thread-safety: as the problem's functions.
#pragma once

#include <functional>

#include <Eigen/Core>

namespace contrejour::inline internal {

// At some parameters: half the sum of squared residuals, its gradient, and the Gauss-Newton approximation of its
// Hessian, J^T J.
struct NormalEquations {
  double cost = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

struct LeastSquaresProblem {
  std::function<NormalEquations(const Eigen::VectorXd&)> equations;
  std::function<double(const Eigen::VectorXd&)> cost;
  Eigen::VectorXd lower = {}, upper = {};  // bounds of the parameters; empty: none
};

struct LeastSquaresSettings {
  int max_iterations = 50;
  double min_relative_decrease = 1e-9;  // of the cost in one step, below which it has converged
  // By how much the cost changes where the parameters do not. Whether a step that is predicted to gain less than twice
  // that has gained cannot be seen: it is taken unless the cost rises by more than the noise, and counts as predicted.
  double cost_noise = 0;
};

struct LeastSquaresResult {
  Eigen::VectorXd parameters;
  double cost = 0;
  Eigen::MatrixXd hessian;  // at the last equations: its inverse is the parameters' covariance where residuals are
                            // in standard deviations
  int iterations = 0;
  bool converged = false;
};

// A parameter without influence keeps its value; one at a bound that the cost pushes it against stays there.
[[nodiscard]] LeastSquaresResult least_squares(const LeastSquaresProblem& problem, Eigen::VectorXd start,
                                               const LeastSquaresSettings& settings = {});

}  // namespace contrejour::inline internal
