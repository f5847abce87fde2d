// SPDX-License-Identifier: Apache-2.0
// Least squares by QR in double: coefficients of polynomials from weighted rays. Householder's QR keeps the accuracy
// that normal equations lose, as they square the condition number (1e5 for order 9).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace contrejour::inline internal::polynomial {

// Row-major, one row a sample.
struct Rows {
  std::size_t columns = 0;
  std::vector<double> values;

  [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
};

class LeastSquares {
 public:
  // ridge: adds the squares of the unknowns times this squared to the mean of the squares that are minimised, so that
  // the unknowns stay small where the rows do not determine them.
  LeastSquares(const Rows& matrix, double ridge);
  ~LeastSquares();
  LeastSquares(LeastSquares&&) noexcept;
  LeastSquares& operator=(LeastSquares&&) noexcept;

  // The unknowns that fit one right-hand side best.
  [[nodiscard]] std::vector<double> solve(std::span<const double> right) const;
  // The same for several right-hand sides of one length, which takes less time than one after the other.
  [[nodiscard]] std::vector<std::vector<double>> solve_all(std::span<const std::vector<double>> right) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace contrejour::inline internal::polynomial
