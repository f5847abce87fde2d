// SPDX-License-Identifier: Apache-2.0
// The arc step decides how finely an arc that clips a cell is divided into chords.
#pragma once

#include <span>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"

namespace contrejour::inline internal::adaptive {

// The step in radians along an arc for which chords miss it by no more pixels than their part of the cell's budget
// allows; twice that distance costs up to 0.7 dB. corners: of the cell. irradiance: its irradiance.
[[nodiscard]] double arc_step(const BandContext& band, const Mesh& mesh, std::span<const CellCorner> corners,
                              const LinearIrradiance& irradiance, double cell_budget);

}  // namespace contrejour::inline internal::adaptive
