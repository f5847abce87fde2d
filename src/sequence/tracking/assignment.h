// SPDX-License-Identifier: Apache-2.0
// Pairs of rows and columns, each in at most one pair, with the largest sum of gains: the assignment problem, exact.
// Thread-safety: a pure function.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace contrejour::inline internal {

// A pair that may be chosen; the others may not.
struct PairGain {
  int row = 0, column = 0;
  std::int64_t gain = 0;  // > 0; whole numbers, so that the optimum is exact
};

// The column of each row; -1 for none.
[[nodiscard]] std::vector<int> best_assignment(int rows, int columns, std::span<const PairGain> pairs);

}  // namespace contrejour::inline internal
