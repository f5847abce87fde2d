// SPDX-License-Identifier: Apache-2.0
// Surfaces are known by their numbers in a document's values: coatings, ghosts that are changed, the selection. When a
// surface is inserted or deleted, or the lens is reversed, these values follow the surfaces that they mean. Numbers
// count from 1, rows from 0. Thread-safety: pure functions.
#pragma once

#include <vector>

#include "studio/core/document.h"

namespace contrejour::studio {

// The new number of each surface of the lens before, in the order of the lens before; 0: it is gone.
using SurfaceNumbers = std::vector<int>;
[[nodiscard]] SurfaceNumbers numbers_after_insertion(std::size_t count, std::size_t row);  // behind the row
[[nodiscard]] SurfaceNumbers numbers_after_deletion(std::size_t count, std::size_t row);
[[nodiscard]] SurfaceNumbers numbers_after_reversal(std::size_t count);

// Values that mean a surface that is gone are left out.
[[nodiscard]] Document with_surface_numbers(Document document, const SurfaceNumbers& numbers);

}  // namespace contrejour::studio
