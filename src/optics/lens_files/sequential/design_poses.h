// SPDX-License-Identifier: Apache-2.0
// Poses of the rows of a design: decentre and tilt relative to their nominal positions on the axis.
#pragma once

#include <vector>

#include "optics/lens_files/sequential/design_rows.h"

namespace contrejour::inline internal {

// Sets the rows' poses, and rotates their shapes and openings. Errors: Unsupported for a decentred or tilted stop or
// image surface, and for poses that differ between zoom positions.
[[nodiscard]] Result<void> place_rows(const SequentialDesign& design, const std::vector<DesignPosition>& positions,
                                      std::vector<DesignRow>& rows);

}  // namespace contrejour::inline internal
