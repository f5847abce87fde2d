// Which positions of a design are those of our zoom.
#pragma once

#include <string>
#include <vector>

#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour {

// With what follows from thicknesses that a position changes: those for distant objects, or else all, as the rest is
// focusing. The design's own thicknesses, if it has no positions.
[[nodiscard]] std::vector<DesignPosition> positions_of(const SequentialDesign& design,
                                                       std::vector<std::string>& warnings);

}  // namespace contrejour
