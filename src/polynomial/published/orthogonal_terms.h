// SPDX-License-Identifier: Apache-2.0
// All terms of a dense fit, made orthogonal to those that are chosen, through the sums over the samples: the error
// after a fit with any further term is then known without the fit (orthogonal least squares; Chen, Billings and Luo
// 1989).
#pragma once

#include <vector>

#include "polynomial/published/dense_state.h"

namespace contrejour::inline internal::polynomial {

class OrthogonalTerms {
 public:
  explicit OrthogonalTerms(const published::DenseFit::State& state);

  void choose(int term);
  // The term that lowers the error most; -1 if all that are left depend on those chosen.
  [[nodiscard]] int best() const;
  [[nodiscard]] double error() const;  // of the chosen terms, fitted
  [[nodiscard]] double error_with(int term) const;

 private:
  [[nodiscard]] double gain(Eigen::Index term) const;

  const published::DenseFit::State& state_;
  std::vector<Eigen::VectorXd> chosen_;  // by chosen term: its products with all terms, orthogonal and normalised
  Eigen::VectorXd squares_;  // of what is left of each term
  Eigen::VectorXd right_;  // product with the values of what is left of each term
  double left_;  // sum of the squares of the residual
};

}  // namespace contrejour::inline internal::polynomial
