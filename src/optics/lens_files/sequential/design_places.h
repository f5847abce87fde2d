// Where the rows of a design stand, beside their places along the axis.
#pragma once

#include <vector>

#include "optics/lens_files/sequential/design_rows.h"

namespace contrejour {

// Sets the rows' poses, and turns their shapes and openings. Errors: Unsupported for a stop or an image surface that
// stands askew, and for poses that are others in another position.
[[nodiscard]] Result<void> place_rows(const SequentialDesign& design, const std::vector<DesignPosition>& positions,
                                      std::vector<DesignRow>& rows);

}  // namespace contrejour
