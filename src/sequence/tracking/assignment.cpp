// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/assignment.h"

#include <algorithm>
#include <limits>

namespace contrejour::inline internal {
namespace {

using Cost = std::int64_t;
constexpr Cost kInfinite = std::numeric_limits<Cost>::max() / 4;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Every row gets a column at the least total cost; there are at least as many columns as rows. Rows are added one by
// one. Prices of rows and columns make every reduced cost at least 0, and 0 for the pairs so far, so that the cheapest
// way to add a row is a shortest path, as Dijkstra's algorithm finds it, along which pairs are exchanged.
class LeastCostAssignment {
 public:
  LeastCostAssignment(std::size_t rows, std::size_t columns)
      : columns_(columns), costs_(rows * columns), row_price_(rows), column_price_(columns), row_of_(columns, kNone) {}

  [[nodiscard]] Cost& cost(std::size_t row, std::size_t column) { return costs_[row * columns_ + column]; }

  void add_row(std::size_t row) {
    distance_.assign(columns_, kInfinite);
    before_.assign(columns_, kNone);
    is_reached_.assign(columns_, false);
    std::size_t at_row = row, column = kNone;
    while (true) {
      relax(at_row, column);
      const std::size_t next = nearest();
      move_prices(row, distance_[next]);
      is_reached_[next] = true;
      column = next;
      if (row_of_[column] == kNone) break;
      at_row = row_of_[column];
    }
    for (; column != kNone; column = before_[column])
      row_of_[column] = before_[column] == kNone ? row : row_of_[before_[column]];
  }

  [[nodiscard]] const std::vector<std::size_t>& row_of_columns() const { return row_of_; }

 private:
  // Paths from the row, which is that of a reached column, to all columns.
  void relax(std::size_t row, std::size_t column) {
    for (std::size_t j = 0; j < columns_; ++j) {
      const Cost reduced = cost(row, j) - row_price_[row] - column_price_[j];
      if (is_reached_[j] || reduced >= distance_[j]) continue;
      distance_[j] = reduced;
      before_[j] = column;
    }
  }

  [[nodiscard]] std::size_t nearest() const {
    std::size_t best = kNone;
    for (std::size_t j = 0; j < columns_; ++j)
      if (!is_reached_[j] && (best == kNone || distance_[j] < distance_[best])) best = j;
    return best;
  }

  // Makes the nearest column's reduced cost 0; distances are from the columns reached so far.
  void move_prices(std::size_t row, Cost step) {
    row_price_[row] += step;
    for (std::size_t j = 0; j < columns_; ++j) {
      if (is_reached_[j]) {
        row_price_[row_of_[j]] += step;
        column_price_[j] -= step;
      } else if (distance_[j] < kInfinite) {
        distance_[j] -= step;
      }
    }
  }

  std::size_t columns_;
  std::vector<Cost> costs_, row_price_, column_price_, distance_;
  std::vector<std::size_t> row_of_, before_;
  std::vector<bool> is_reached_;
};

}  // namespace

// Each row has a column of its own besides, which means that it has no pair and costs nothing.
std::vector<int> best_assignment(int rows, int columns, std::span<const PairGain> pairs) {
  const auto height = static_cast<std::size_t>(rows), width = static_cast<std::size_t>(columns);
  LeastCostAssignment assignment(height, width + height);
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width + height; ++column)
      if (column != width + row) assignment.cost(row, column) = kInfinite / 4;
  for (const PairGain& pair : pairs)
    assignment.cost(static_cast<std::size_t>(pair.row), static_cast<std::size_t>(pair.column)) = -pair.gain;
  for (std::size_t row = 0; row < height; ++row) assignment.add_row(row);
  std::vector<int> column_of_row(height, -1);
  for (std::size_t column = 0; column < width; ++column)
    if (const std::size_t row = assignment.row_of_columns()[column]; row != kNone)
      column_of_row[row] = static_cast<int>(column);
  return column_of_row;
}

}  // namespace contrejour::inline internal
