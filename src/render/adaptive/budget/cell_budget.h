// SPDX-License-Identifier: Apache-2.0
// The squared error that each cell of a band may make.
#pragma once

#include <algorithm>

namespace contrejour::inline internal::adaptive {

// The number of cells is not known beforehand: a cell's part of the band's budget falls as they become more, down to a
// quarter. If it fell further, most cells would be spent where light is focused, without gain.
class CellBudget {
 public:
  // All cells together make no more than the band's squared error, as long as there are at most kManyCells times
  // few_cells of them.
  CellBudget(double of_band, double few_cells) : of_band_(of_band), few_cells_(few_cells) {}

  [[nodiscard]] double of_next_cell() const {
    return of_band_ / std::clamp(cells_, few_cells_, kManyCells * few_cells_);
  }
  void add_cell() { cells_ += 1.0; }
  void start_band() { cells_ = 0.0; }

 private:
  static constexpr double kManyCells = 4.0;

  double of_band_, few_cells_;
  double cells_ = 0.0;  // chosen for this band
};

}  // namespace contrejour::inline internal::adaptive
