// SPDX-License-Identifier: Apache-2.0
// Least squares of unknowns that grow: what any solution must satisfy, computed without a factorisation.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "polynomial/least_squares.h"

using namespace contrejour::polynomial;

namespace {

// At the minimum the gradient of |A x - b|^2 + (ridge^2 rows) |x|^2 vanishes: A^T (A x - b) + ridge^2 rows x = 0.
double largest_gradient(const std::vector<std::vector<double>>& columns, std::size_t rows,
                        const std::vector<double>& right, double ridge, const std::vector<double>& x) {
  std::vector<double> rest(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    rest[row] = -right[row];
    for (std::size_t k = 0; k < x.size(); ++k) rest[row] += columns[k][row] * x[k];
  }
  double largest = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    double gradient = ridge * ridge * static_cast<double>(rows) * x[k];
    for (std::size_t row = 0; row < rows; ++row) gradient += columns[k][row] * rest[row];
    largest = std::max(largest, std::abs(gradient));
  }
  return largest;
}

}  // namespace

TEST_CASE("least squares of unknowns that are added minimise with each number of them") {
  constexpr std::size_t kRows = 83;  // no multiple of a packet
  constexpr double kRidge = 1e-3;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<std::vector<double>> columns, rights(3, std::vector<double>(kRows));
  for (auto& right : rights)
    for (double& value : right) value = normal(random);
  GrowingLeastSquares squares(kRows, kRidge);
  std::vector<double> padded(rights.size() * squares.padded_rows(), 0.0);
  for (std::size_t k = 0; k < rights.size(); ++k)
    std::ranges::copy(rights[k], padded.data() + k * squares.padded_rows());
  GrowingLeastSquares::Right right(padded);
  const std::vector<std::size_t> steps{1, 5, 23, 40};  // less and more than a panel's columns
  for (const std::size_t until : steps) {
    const std::size_t added = until - columns.size();
    std::vector<double> block(added * squares.padded_rows(), 0.0);
    for (std::size_t k = 0; k < added; ++k) {
      std::vector<double>& column = columns.emplace_back(kRows);
      for (double& value : column) value = normal(random);
      std::ranges::copy(column, block.data() + k * squares.padded_rows());
    }
    squares.add(std::move(block));
    CHECK(squares.unknowns() == until);
    const auto solutions = squares.solve(right, until);
    REQUIRE(solutions.size() == rights.size());
    for (std::size_t k = 0; k < rights.size(); ++k)
      CHECK(largest_gradient(columns, kRows, rights[k], kRidge, solutions[k]) < 1e-11);
  }
  // The first unknowns can be solved for alone in a system that has grown further.
  for (const std::size_t first : steps) {
    GrowingLeastSquares::Right again(padded);
    const auto solutions = squares.solve(again, first);
    CHECK(solutions.front().size() == first);
    CHECK(largest_gradient(columns, kRows, rights.front(), kRidge, solutions.front()) < 1e-11);
  }
}

TEST_CASE("a ridge keeps unknowns small that the rows do not determine") {
  Rows rows{2, {}};
  std::vector<double> right;
  for (int k = 0; k < 20; ++k) {
    rows.values.insert(rows.values.end(), {1.0, 1.0});  // only their sum matters
    right.push_back(3.0);
  }
  const std::vector<double> x = LeastSquares(rows, 1e-4).solve(right);
  CHECK(x[0] == doctest::Approx(1.5).epsilon(1e-6));
  CHECK(x[1] == doctest::Approx(1.5).epsilon(1e-6));
}
