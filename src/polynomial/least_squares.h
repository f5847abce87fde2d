// SPDX-License-Identifier: Apache-2.0
// Least squares by QR in double: coefficients of polynomials from weighted rays. Householder's QR keeps the accuracy
// that normal equations lose, as they square the condition number (1e5 for order 9).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "polynomial/reflectors.h"

namespace contrejour::inline internal::polynomial {

// Row-major, one row a sample.
struct Rows {
  std::size_t columns = 0;
  std::vector<double> values;

  [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
};

// Least squares with unknowns that are added to those there are: the factorisation for few unknowns is the first part
// of that for more. Polynomials of all degrees so cost as much as that of the highest.
class GrowingLeastSquares {
 public:
  // ridge: adds the squares of the unknowns times this squared to the mean of the squares that are minimised, so that
  // the unknowns stay small where the rows do not determine them.
  GrowingLeastSquares(std::size_t rows, double ridge);
  GrowingLeastSquares(GrowingLeastSquares&&) = default;
  GrowingLeastSquares& operator=(GrowingLeastSquares&&) = default;
  GrowingLeastSquares(const GrowingLeastSquares&) = delete;
  GrowingLeastSquares& operator=(const GrowingLeastSquares&) = delete;
  ~GrowingLeastSquares() = default;

  // Adds unknowns by their columns, one after the other, each padded with zeros to padded_rows().
  void add(std::vector<double> columns);
  [[nodiscard]] std::size_t unknowns() const { return triangle_.size(); }
  [[nodiscard]] std::size_t padded_rows() const { return padded_rows_; }

  // Right-hand sides that are transformed as far as it was needed.
  class Right {
   public:
    explicit Right(std::vector<double> columns) : rest_(std::move(columns)) {}

   private:
    friend class GrowingLeastSquares;
    std::vector<double> rest_;  // padded columns
    std::vector<std::vector<double>> transformed_;  // by column, one value for each unknown
    std::size_t panels_ = 0;
  };
  // The unknowns that fit each of the right-hand sides best, of those that were added first. `unknowns`: as many as
  // there were after one of the additions; with the same right-hand sides it must not fall from call to call.
  [[nodiscard]] std::vector<std::vector<double>> solve(Right& right, std::size_t unknowns) const;

 private:
  std::size_t padded_rows_ = 0;
  double ridge_ = 0.0;
  std::vector<std::vector<double>> blocks_;  // as they were added: the reflections' vectors
  std::vector<Panel> panels_;
  std::vector<const double*> panel_vectors_;
  std::vector<std::vector<double>> triangle_;  // by column, from the first row to the diagonal
};

// With all unknowns at once.
class LeastSquares {
 public:
  // ridge: as above.
  LeastSquares(const Rows& matrix, double ridge);

  // The unknowns that fit one right-hand side best.
  [[nodiscard]] std::vector<double> solve(std::span<const double> right) const;
  // The same for several right-hand sides of one length, which takes less time than one after the other.
  [[nodiscard]] std::vector<std::vector<double>> solve_all(std::span<const std::vector<double>> right) const;

 private:
  GrowingLeastSquares squares_;
};

}  // namespace contrejour::inline internal::polynomial
