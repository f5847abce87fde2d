// SPDX-License-Identifier: Apache-2.0
#include "polynomial/least_squares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace contrejour::inline internal::polynomial {

GrowingLeastSquares::GrowingLeastSquares(std::size_t rows, double ridge)
    : padded_rows_((std::max<std::size_t>(rows, 1) + kRowsMultiple - 1) / kRowsMultiple * kRowsMultiple),
      ridge_(ridge * std::sqrt(static_cast<double>(rows))) {}

void GrowingLeastSquares::add(std::vector<double> columns) {
  const std::size_t before = unknowns(), added = columns.size() / padded_rows_;
  triangle_.resize(before + added);
  for (std::size_t k = before; k < triangle_.size(); ++k) triangle_[k].resize(k + 1);
  std::vector<double> panel_rows(added * kPanelColumns);
  // The rows of R of one panel, in columns from `first` of those added on.
  const auto apply = [&](const Panel& panel, const double* vectors, std::size_t first) {
    reflect(panel, vectors, padded_rows_, columns.data() + first * padded_rows_, added - first, panel_rows.data());
    for (std::size_t k = first; k < added; ++k)
      std::copy_n(panel_rows.data() + (k - first) * kPanelColumns, panel.count,
                  triangle_[before + k].data() + panel.first);
  };
  for (std::size_t p = 0; p < panels_.size(); ++p) apply(panels_[p], panel_vectors_[p], 0);
  for (std::size_t at = 0; at < added; at += kPanelColumns) {
    Panel& panel = panels_.emplace_back(Panel{before + at, std::min(kPanelColumns, added - at), {}});
    double* const vectors = columns.data() + at * padded_rows_;
    panel_vectors_.push_back(vectors);  // stays valid, as the block moves into blocks_
    std::array<std::array<double, kPanelColumns>, kPanelColumns> r{};
    factor_panel(vectors, padded_rows_, ridge_, panel, r);
    for (std::size_t k = 0; k < panel.count; ++k)
      for (std::size_t j = 0; j <= k; ++j) triangle_[panel.first + k][panel.first + j] = r[j][k];
    apply(panel, vectors, at + panel.count);
  }
  blocks_.push_back(std::move(columns));
}

std::vector<std::vector<double>> GrowingLeastSquares::solve(Right& right, std::size_t unknowns) const {
  const std::size_t count = right.rest_.size() / padded_rows_;
  right.transformed_.resize(count);
  std::vector<double> panel_rows(count * kPanelColumns);
  for (; right.panels_ < panels_.size() && panels_[right.panels_].first < unknowns; ++right.panels_) {
    const Panel& panel = panels_[right.panels_];
    reflect(panel, panel_vectors_[right.panels_], padded_rows_, right.rest_.data(), count, panel_rows.data());
    for (std::size_t k = 0; k < count; ++k) {
      const double* const values = panel_rows.data() + k * kPanelColumns;
      right.transformed_[k].insert(right.transformed_[k].end(), values, values + panel.count);
    }
  }
  std::vector<std::vector<double>> solutions = right.transformed_;
  for (std::vector<double>& x : solutions) {
    for (std::size_t k = unknowns; k-- > 0;) {
      const std::vector<double>& column = triangle_[k];
      // Without a ridge, an unknown on which nothing depends is 0.
      x[k] = column[k] != 0.0 ? x[k] / column[k] : 0.0;
      for (std::size_t i = 0; i < k; ++i) x[i] -= column[i] * x[k];
    }
  }
  return solutions;
}

LeastSquares::LeastSquares(const Rows& matrix, double ridge) : squares_(matrix.rows(), ridge) {
  const std::size_t padded = squares_.padded_rows();
  std::vector<double> columns(padded * matrix.columns, 0.0);
  for (std::size_t row = 0, at = 0; row < matrix.rows(); ++row)
    for (std::size_t k = 0; k < matrix.columns; ++k, ++at) columns[k * padded + row] = matrix.values[at];
  squares_.add(std::move(columns));
}

std::vector<double> LeastSquares::solve(std::span<const double> right) const {
  return solve_all(std::array{std::vector<double>(right.begin(), right.end())}).front();
}

std::vector<std::vector<double>> LeastSquares::solve_all(std::span<const std::vector<double>> right) const {
  const std::size_t padded = squares_.padded_rows();
  std::vector<double> columns(padded * right.size(), 0.0);
  for (std::size_t k = 0; k < right.size(); ++k) std::ranges::copy(right[k], columns.data() + k * padded);
  GrowingLeastSquares::Right all(std::move(columns));
  return squares_.solve(all, squares_.unknowns());
}

}  // namespace contrejour::inline internal::polynomial
