// SPDX-License-Identifier: Apache-2.0
// Which squares of a mesh are visible cells.
#pragma once

#include <optional>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/cells/cell_plane.h"

namespace contrejour::inline internal::adaptive {

// Empty if all light is blocked, dimmer than the negligible level, or off the frame.
[[nodiscard]] std::optional<Cell> visible_cell(const BandContext& band, const BoxMesh& of, const MeshSquare& square);

}  // namespace contrejour::inline internal::adaptive
