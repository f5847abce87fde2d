// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/reflectance_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace contrejour::inline internal {
namespace {

constexpr double kMostRelativeError = 0.35;  // of an energy that has a logarithm
constexpr double kHuberOfRatios = 2.0;       // standard deviations
constexpr int kRobustRounds = 6;

struct LinearProblem {
  Eigen::MatrixXd rows;  // one for each ghost with a logarithm, in standard deviations
  Eigen::VectorXd right;
};

LinearProblem linear_problem(std::span<const GhostSurfaces> ghosts, const Eigen::VectorXd& ratio,
                             const Eigen::VectorXd& error, int unknowns) {
  std::vector<Eigen::Index> used;
  for (Eigen::Index k = 0; k < ratio.size(); ++k) {
    const auto& of = ghosts[static_cast<std::size_t>(k)].unknown;
    if (ratio[k] > 0.0 && error[k] > 0.0 && error[k] < kMostRelativeError * ratio[k] && std::max(of[0], of[1]) >= 0)
      used.push_back(k);
  }
  LinearProblem problem{Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(used.size()), unknowns),
                        Eigen::VectorXd(static_cast<Eigen::Index>(used.size()))};
  for (std::size_t m = 0; m < used.size(); ++m) {
    const Eigen::Index k = used[m];
    const double weight = ratio[k] / error[k];
    for (const int unknown : ghosts[static_cast<std::size_t>(k)].unknown)
      if (unknown >= 0) problem.rows(static_cast<Eigen::Index>(m), unknown) += weight;
    problem.right[static_cast<Eigen::Index>(m)] = weight * std::log(ratio[k]);
  }
  return problem;
}

Eigen::VectorXd solved(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right, double prior) {
  Eigen::MatrixXd a = rows.transpose() * rows;
  a.diagonal().array() += 1.0 / (prior * prior);
  return a.ldlt().solve(rows.transpose() * right);
}

// Weights of Huber's loss, by iterated least squares.
Eigen::VectorXd robust_solution(const LinearProblem& problem, double prior) {
  Eigen::VectorXd x = solved(problem.rows, problem.right, prior);
  for (int round = 0; round < kRobustRounds; ++round) {
    const Eigen::VectorXd off = problem.right - problem.rows * x;
    const Eigen::VectorXd root = off.unaryExpr(
        [](double r) { return std::abs(r) > kHuberOfRatios ? std::sqrt(kHuberOfRatios / std::abs(r)) : 1.0; });
    x = solved(root.asDiagonal() * problem.rows, root.cwiseProduct(problem.right), prior);
  }
  return x;
}

}  // namespace

ReflectanceFit fit_logarithms(std::span<const GhostSurfaces> ghosts, const Eigen::VectorXd& ratio,
                              const Eigen::VectorXd& error, const Eigen::VectorXd& expected,
                              const ReflectanceOptions& options) {
  const auto unknowns = static_cast<int>(expected.size());
  LinearProblem problem = linear_problem(ghosts, ratio, error, unknowns);
  ReflectanceFit fit;
  fit.error = Eigen::VectorXd::Constant(unknowns, options.prior);
  if (problem.rows.rows() == 0) {
    fit.x = expected;
    for (int k = 0; k < unknowns; ++k) fit.open.push_back(Eigen::VectorXd::Unit(unknowns, k));
    return fit;
  }
  problem.right -= problem.rows * expected;
  fit.x = expected + robust_solution(problem, options.prior);
  // Along a singular vector, x has the standard error 1 / (singular value).
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(problem.rows, Eigen::ComputeFullV);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(unknowns);
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const double value = k < svd.singularValues().size() ? svd.singularValues()[k] : 0.0;
    const Eigen::VectorXd direction = svd.matrixV().col(k);
    const bool is_open = !(value * options.most_error > 1.0);
    const double of = is_open ? options.prior : 1.0 / value;
    variance += of * of * direction.cwiseAbs2();
    if (is_open)
      fit.open.push_back(direction);
    else
      ++fit.rank;
  }
  fit.error = variance.cwiseSqrt();
  return fit;
}

}  // namespace contrejour::inline internal
