// SPDX-License-Identifier: Apache-2.0
// Names the surfaces whose reflectances ghosts cannot tell apart.
// Thread-safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "measure/prescription/reflectance_fit.h"

namespace contrejour::inline internal {

// A sentence for each group of surfaces that share an open direction. surfaces: the number of each unknown's surface.
[[nodiscard]] std::vector<std::string> open_surface_texts(std::span<const OpenDirection> open,
                                                          std::span<const int> surfaces);

}  // namespace contrejour::inline internal
