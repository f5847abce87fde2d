// SPDX-License-Identifier: Apache-2.0
// Code that readers of glasses share.
#pragma once

#include <cstddef>

#include "contrejour/expert/glass_catalogue.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kMaxGlassFileBytes = std::size_t{8} << 20U;  // the largest known has 1.2 MB

// Computes n_d and V_d from the glass if its catalogue states none and its range contains the lines C to F.
void fill_stated(CatalogueEntry& entry);

}  // namespace contrejour::inline internal
