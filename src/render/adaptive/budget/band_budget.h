// SPDX-License-Identifier: Apache-2.0
// The error that each band of wavelengths of an item may make, and the fewest cells that share it.
#pragma once

#include <algorithm>
#include <cstddef>

#include "render/adaptive/budget/tolerance.h"

namespace contrejour::inline internal::adaptive {

inline constexpr double kFewCells = 96.0;  // each cell, of at least this many, has an equal part of a band's error

// Each band, of at least three, has an equal part of an item's squared error.
[[nodiscard]] inline ErrorBudget budget_per_band(const ErrorBudget& of_item, std::size_t bands) {
  constexpr double kFewBands = 3.0;
  return {of_item.squared_error / std::max(static_cast<double>(bands), kFewBands), of_item.peak};
}

}  // namespace contrejour::inline internal::adaptive
