// SPDX-License-Identifier: Apache-2.0
#include "polynomial/published/term_tables.h"

#include <cmath>
#include <vector>

namespace contrejour::inline internal::polynomial {

void one_variable(published::Basis basis, int degree, double x, std::span<double> values) {
  values[0] = 1.0;
  if (degree > 0) values[1] = x;
  for (int k = 1; k < degree; ++k) {
    const auto n = static_cast<std::size_t>(k);
    values[n + 1] = basis == published::Basis::Monomials ? x * values[n]
                                                         : ((2.0 * k + 1.0) * x * values[n] - k * values[n - 1]) /
                                                               (k + 1.0);  // Bonnet's recursion: P_n(1) = 1
  }
  if (basis == published::Basis::Legendre)
    for (int k = 0; k <= degree; ++k) values[static_cast<std::size_t>(k)] *= std::sqrt(2.0 * k + 1.0);
}

TermTables::TermTables(published::Basis basis, int degree, std::span<const published::Inputs> inputs) {
  std::vector<double> values(static_cast<std::size_t>(degree) + 1);
  for (std::size_t axis = 0; axis < tables_.size(); ++axis) {
    auto& table = tables_[axis];
    table.resize(static_cast<Eigen::Index>(inputs.size()), degree + 1);
    for (std::size_t row = 0; row < inputs.size(); ++row) {
      one_variable(basis, degree, inputs[row][axis], values);
      for (int k = 0; k <= degree; ++k) table(static_cast<Eigen::Index>(row), k) = values[static_cast<std::size_t>(k)];
    }
  }
}

}  // namespace contrejour::inline internal::polynomial
