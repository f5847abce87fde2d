// SPDX-License-Identifier: Apache-2.0
// Finds irradiances that many cells of a mesh have in common (cells/cell_plane.h).
#pragma once

#include <optional>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/cells/cell_plane.h"

namespace contrejour::inline internal::adaptive {

// The square of a quarter of a mesh: 0 low, 1 high in x, 2 and 3 the same, high in y.
[[nodiscard]] inline MeshSquare quarter_square(std::size_t q) {
  constexpr int kHalf = Mesh::kCells / 2;
  return {kHalf * static_cast<int>(q % 2), kHalf * static_cast<int>(q / 2), kHalf};
}

// The plane for the cells of a square, if one serves them.
[[nodiscard]] std::optional<LinearIrradiance> plane_for(const BandContext& band, const Mesh& mesh,
                                                        const MeshSquare& square, double cell_budget);

// Sets BoxMesh::plane to one plane for the whole mesh, or else to one for each quarter that a plane serves.
void find_planes(const BandContext& band, BoxMesh& of, double cell_budget);

}  // namespace contrejour::inline internal::adaptive
