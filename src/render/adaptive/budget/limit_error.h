// SPDX-License-Identifier: Apache-2.0
// The displacement of the edges that clip a cell when it is drawn as one polygon.
#pragma once

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/cell.h"

namespace contrejour::inline internal::adaptive {

// The displacement of the lines that clip the cell when stop coordinates and heights at rims are taken as linear along
// its sides, as a fraction of the cell.
[[nodiscard]] double limit_error(const BandContext& band, const Mesh& mesh, const Cell& cell);

}  // namespace contrejour::inline internal::adaptive
