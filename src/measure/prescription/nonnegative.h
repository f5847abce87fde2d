// SPDX-License-Identifier: Apache-2.0
// Linear least squares with unknowns that are not below 0, from normal equations.
// Source: Lawson and Hanson, Solving Least Squares Problems (1974), 23.3; from normal equations Bro and De Jong, J.
// Chemometrics 11 (1997) 393.
// Thread-safety: pure functions.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace contrejour::inline internal {

struct NonnegativeSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd error;         // standard errors, 0 for unknowns without influence; those at 0 count as if alone
  Eigen::MatrixXd correlation;   // of those above 0; the unit matrix's elements for the others
};

// Minimises x^T A x / 2 - b^T x over x >= 0, with A = J^T W J and b = J^T W y.
[[nodiscard]] NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace contrejour::inline internal
