// SPDX-License-Identifier: Apache-2.0
// Selects the positions of a design that form our zoom.
#pragma once

#include <string>
#include <vector>

#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

// The positions with all solves evaluated: those for distant objects if there are any, since the others are focusing,
// else all. Without positions the design's own thicknesses.
[[nodiscard]] std::vector<DesignPosition> positions_of(const SequentialDesign& design,
                                                       std::vector<std::string>& warnings);

}  // namespace contrejour::inline internal
