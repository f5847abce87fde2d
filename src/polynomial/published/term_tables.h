// SPDX-License-Identifier: Apache-2.0
// Values of the basis at samples: each variable's polynomials in a table, whose products are the terms.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "contrejour/expert/published_fits.h"

namespace contrejour::inline internal::polynomial {

// The polynomials of degree 0 to `degree` at x.
void one_variable(published::Basis basis, int degree, double x, std::span<double> values);

class TermTables {
 public:
  TermTables(published::Basis basis, int degree, std::span<const published::Inputs> inputs);

  [[nodiscard]] Eigen::Index rows() const { return tables_[0].rows(); }
  // A term's values at `count` samples from `first` on.
  [[nodiscard]] auto column(const published::Exponents& e, Eigen::Index first, Eigen::Index count) const {
    return tables_[0].col(e[0]).segment(first, count) * tables_[1].col(e[1]).segment(first, count) *
           tables_[2].col(e[2]).segment(first, count) * tables_[3].col(e[3]).segment(first, count);
  }

 private:
  std::array<Eigen::ArrayXXd, 4> tables_;  // by variable: one row a sample, one column a degree
};

}  // namespace contrejour::inline internal::polynomial
