// SPDX-License-Identifier: Apache-2.0
// The sums over all samples that a dense fit keeps for searches among its terms, from which any choice of terms is
// fitted and rated without the samples.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "contrejour/expert/published_fits.h"
#include "polynomial/published/term_tables.h"

namespace contrejour::published {

struct DenseFit::State {
  Samples samples;
  polynomial::TermTables tables;
  std::vector<Exponents> terms;
  Polynomial polynomial;
  // With one row of A a sample and one column a term: A'A, A'y and y'y. From the R of A's QR, so that A'A is as
  // accurate as double permits.
  Eigen::MatrixXd products;
  Eigen::VectorXd right;
  double squares = 0.0;
  double error = 0.0, seconds = 0.0;
};

}  // namespace contrejour::published

namespace contrejour::inline internal::polynomial {

struct SubsetFit {
  Eigen::VectorXd coefficients;
  double error = 0.0;  // infinite for terms that depend on each other
};

// Fits a choice of terms, given by their indices, by Cholesky's factors of the sums.
[[nodiscard]] SubsetFit fit_subset(const published::DenseFit::State& state, std::span<const int> subset);

// The error of a choice of terms with these coefficients.
[[nodiscard]] double subset_error(const published::DenseFit::State& state, std::span<const int> subset,
                                  const Eigen::VectorXd& coefficients);

// The dense polynomial's coefficients of these terms.
[[nodiscard]] Eigen::VectorXd dense_coefficients(const published::DenseFit::State& state, std::span<const int> subset);

// The polynomial of a choice of terms with these coefficients, or fitted to all samples by QR.
[[nodiscard]] published::Polynomial subset_polynomial(const published::DenseFit::State& state,
                                                      std::span<const int> subset, const Eigen::VectorXd& coefficients);
[[nodiscard]] published::Polynomial refined_subset(const published::DenseFit::State& state,
                                                   std::span<const int> subset);

}  // namespace contrejour::inline internal::polynomial
