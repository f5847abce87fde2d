// SPDX-License-Identifier: Apache-2.0
// The errors of what is looked up or drawn in other planes than the frame: a stop pattern in the stop, shadows in the
// plane of the dirt.
#pragma once

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/cell.h"

namespace contrejour::inline internal::adaptive {

// Returns whether pixels are too far apart to look up the stop pattern: a pixel's centre may lie outside the cell, and
// its stop point far from all points that the cell's light crosses. Such cells are drawn in parts.
[[nodiscard]] bool sees_by_parts(const BandContext& band, const Mesh& mesh, const Cell& cell, double longest_px);

// The largest error of the polynomial map from pixels to stop points at the cell's vertices, as a fraction of the cell.
[[nodiscard]] double map_error(const BandContext& band, const Mesh& mesh, const Cell& cell, double longest_px);

// The squared displacement of shadows in the cell's two triangles, summed over the pixels along their edges.
[[nodiscard]] double shadow_error(const BandContext& band, const Mesh& mesh, const Cell& cell);

}  // namespace contrejour::inline internal::adaptive
