// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace contrejour::inline internal {
namespace {

constexpr double kFirstDamping = 1e-3;  // of the Hessian's diagonal
constexpr int kSmallSteps = 3;  // in a row: one may be small because damping was high
constexpr double kMaxDamping = 1e12;
constexpr int kBoundRounds = 6;  // for parameters that stop at a bound
constexpr double kMinDamping = 1e-12;  // keeps parameters that act alike from drifting apart

Eigen::VectorXd within_bounds(const LeastSquaresProblem& problem, Eigen::VectorXd at) {
  if (problem.lower.size() == at.size()) at = at.cwiseMax(problem.lower).cwiseMin(problem.upper).eval();
  return at;
}

// The step under damping of each parameter by its own diagonal entry, which ends at the bounds. The equations are
// scaled to a diagonal of 1, because units of parameters may differ by many orders of magnitude; what has no influence,
// or is held, stays. Parameters that would pass a bound stop at it, and the others are solved anew for that: if the
// step were merely cut off, parameters that depend on one another would go astray, and a fit would seem to have
// converged.
Eigen::VectorXd damped_step(const LeastSquaresProblem& problem, const NormalEquations& equations,
                            const Eigen::VectorXd& at, Eigen::VectorXd is_free, double damping) {
  Eigen::VectorXd stopped = Eigen::VectorXd::Zero(at.size());
  Eigen::VectorXd step = stopped;
  for (int round = 0; round < kBoundRounds; ++round) {
    const Eigen::VectorXd scale = is_free.cwiseProduct(
        equations.hessian.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; }));
    Eigen::MatrixXd scaled = scale.asDiagonal() * equations.hessian * scale.asDiagonal();
    scaled.diagonal() = Eigen::VectorXd::Constant(scale.size(), 1.0 + damping + kMinDamping);
    const Eigen::VectorXd gradient = equations.gradient + equations.hessian * stopped;
    step = stopped + scale.cwiseProduct(scaled.ldlt().solve(-scale.cwiseProduct(gradient)));
    const Eigen::VectorXd within = within_bounds(problem, at + step) - at;
    bool passes = false;
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      if (is_free[k] == 0.0 || at[k] + step[k] == at[k] + within[k]) continue;
      passes = true;
      is_free[k] = 0.0;
      stopped[k] = within[k];
    }
    if (!passes) break;
  }
  return within_bounds(problem, at + step) - at;
}

// 0 for parameters at a bound beyond which the cost would fall, else 1.
Eigen::VectorXd free_parameters(const LeastSquaresProblem& problem, const Eigen::VectorXd& at,
                                const Eigen::VectorXd& gradient) {
  Eigen::VectorXd is_free = Eigen::VectorXd::Ones(at.size());
  if (problem.lower.size() != at.size()) return is_free;
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const bool held =
        (at[k] <= problem.lower[k] && gradient[k] > 0.0) || (at[k] >= problem.upper[k] && gradient[k] < 0.0);
    if (held) is_free[k] = 0.0;
  }
  return is_free;
}

}  // namespace

LeastSquaresResult least_squares(const LeastSquaresProblem& problem, Eigen::VectorXd start,
                                 const LeastSquaresSettings& settings) {
  LeastSquaresResult result;
  result.parameters = within_bounds(problem, std::move(start));
  if (result.parameters.size() == 0) {
    result.cost = problem.cost(result.parameters);
    result.converged = true;
    return result;
  }
  NormalEquations equations = problem.equations(result.parameters);
  double damping = kFirstDamping, growth = 2.0;
  int small_steps = 0;
  while (result.iterations < settings.max_iterations && damping < kMaxDamping) {
    const Eigen::VectorXd is_free = free_parameters(problem, result.parameters, equations.gradient);
    const Eigen::VectorXd step = damped_step(problem, equations, result.parameters, is_free, damping);
    const double predicted = -(equations.gradient.dot(step) + 0.5 * step.dot(equations.hessian * step));
    if (predicted < 0.0) {  // bounds turned the step uphill; a shorter one goes downhill
      damping *= growth;
      growth *= 2.0;
      continue;
    }
    ++result.iterations;
    const Eigen::VectorXd next = result.parameters + step;
    NormalEquations trial = problem.equations(next);
    const double decrease = equations.cost - trial.cost;
    const bool may_gain = predicted > 0.0 && predicted < 2.0 * settings.cost_noise;
    if (!(decrease > (may_gain ? -settings.cost_noise : 0.0)) || !std::isfinite(trial.cost)) {
      if (predicted <= settings.min_relative_decrease * equations.cost) {
        result.converged = true;
        break;
      }
      damping *= growth;
      growth *= 2.0;
      continue;
    }
    result.parameters = next;
    const double relative = (may_gain ? predicted : decrease) / std::max(equations.cost, 1e-300);
    const double gain = predicted > 0.0 && !may_gain ? decrease / predicted : 1.0;
    damping *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3));
    growth = 2.0;
    equations = std::move(trial);
    small_steps = relative < settings.min_relative_decrease ? small_steps + 1 : 0;
    if (small_steps >= kSmallSteps) {
      result.converged = true;
      break;
    }
  }
  result.cost = equations.cost;
  result.hessian = equations.hessian;
  return result;
}

}  // namespace contrejour::inline internal
