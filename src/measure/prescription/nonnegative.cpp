// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/nonnegative.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace contrejour::inline internal {
namespace {

constexpr double kLeastPivot = 1e-9;  // relative to the diagonal, so that two equal columns have a solution

using Indices = std::vector<Eigen::Index>;

Eigen::MatrixXd part_of(const Eigen::MatrixXd& a, const Indices& at) {
  Eigen::MatrixXd part = a(at, at);
  part.diagonal() *= 1.0 + kLeastPivot;
  return part;
}

// The unknowns that may be above 0, with the others at 0.
class ActiveSet {
 public:
  ActiveSet(const Eigen::MatrixXd& a, const Eigen::VectorXd& b)
      : a_(a), b_(b), x_(Eigen::VectorXd::Zero(b.size())), is_free_(static_cast<std::size_t>(b.size()), false) {}

  void solve() {
    const int most = 10 * static_cast<int>(b_.size()) + 10;
    for (int k = 0; k < most; ++k) {
      const Eigen::Index next = steepest();
      if (next < 0) break;
      is_free_[static_cast<std::size_t>(next)] = true;
      while (!take_step()) {
      }
    }
  }

  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] Indices free_indices() const {
    Indices at;
    for (Eigen::Index k = 0; k < b_.size(); ++k)
      if (is_free_[static_cast<std::size_t>(k)]) at.push_back(k);
    return at;
  }

 private:
  // The unknown at 0 that lowers the cost most when it rises; -1: none does.
  [[nodiscard]] Eigen::Index steepest() const {
    constexpr double kFlat = 1e-10;  // of the gradient at 0
    const Eigen::VectorXd down = b_ - a_ * x_;
    Eigen::Index best = -1;
    double most = kFlat * std::max(b_.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    for (Eigen::Index k = 0; k < b_.size(); ++k) {
      if (is_free_[static_cast<std::size_t>(k)] || a_(k, k) <= 0.0 || down[k] <= most) continue;
      most = down[k];
      best = k;
    }
    return best;
  }

  // Towards the solution of the free unknowns, up to where the first of them reaches 0. True once all are above 0.
  bool take_step() {
    const Indices at = free_indices();
    if (at.empty()) return true;
    const Eigen::VectorXd wanted = part_of(a_, at).ldlt().solve(b_(at));
    double step = 1.0;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double now = x_[at[k]], then = wanted[static_cast<Eigen::Index>(k)];
      if (then <= 0.0) step = std::min(step, now > then ? now / (now - then) : 0.0);
    }
    bool all = true;
    for (std::size_t k = 0; k < at.size(); ++k) {
      double& value = x_[at[k]];
      const double then = wanted[static_cast<Eigen::Index>(k)];
      value = step >= 1.0 ? then : value + step * (then - value);
      if (then > 0.0 || value > 1e-12 * std::abs(then)) continue;
      value = 0.0;
      is_free_[static_cast<std::size_t>(at[k])] = false;
      all = false;
    }
    return all;
  }

  const Eigen::MatrixXd& a_;
  const Eigen::VectorXd& b_;
  Eigen::VectorXd x_;
  std::vector<bool> is_free_;
};

}  // namespace

NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  if (b.size() == 0) return {};
  // Columns differ by orders of magnitude: in units of their own influence they do not.
  Eigen::VectorXd scale(b.size());
  for (Eigen::Index k = 0; k < b.size(); ++k) scale[k] = a(k, k) > 0.0 ? 1.0 / std::sqrt(a(k, k)) : 0.0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * a * scale.asDiagonal();
  const Eigen::VectorXd right = scale.cwiseProduct(b);
  ActiveSet set(scaled, right);
  set.solve();
  NonnegativeSolution solution{scale.cwiseProduct(set.x()), scale, Eigen::MatrixXd::Identity(b.size(), b.size())};
  const Indices at = set.free_indices();
  if (at.empty()) return solution;
  const auto count = static_cast<Eigen::Index>(at.size());
  const Eigen::MatrixXd covariance = part_of(scaled, at).ldlt().solve(Eigen::MatrixXd::Identity(count, count));
  for (Eigen::Index m = 0; m < count; ++m) {
    const double variance = std::max(covariance(m, m), 0.0);
    solution.error[at[static_cast<std::size_t>(m)]] = scale[at[static_cast<std::size_t>(m)]] * std::sqrt(variance);
    for (Eigen::Index n = 0; n < count; ++n) {
      const double both = std::sqrt(covariance(m, m) * covariance(n, n));
      if (m != n && both > 0.0)
        solution.correlation(at[static_cast<std::size_t>(m)], at[static_cast<std::size_t>(n)]) =
            covariance(m, n) / both;
    }
  }
  return solution;
}

}  // namespace contrejour::inline internal
