// SPDX-License-Identifier: Apache-2.0
// Chooses the cells that a patch is drawn as: from the top down, each as large as its allowed error permits, small
// where the map folds and at the edges along which the iris and the rims clip them.
#pragma once

#include "render/adaptive/budget/cell_budget.h"
#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/cells/cell_plane.h"

namespace contrejour::inline internal::adaptive {

class CellChooser {
 public:
  // All arguments must outlive this object. The budget counts the cells that are chosen, which are added to `cells`.
  CellChooser(const BandContext& band, CellBudget& budget, BoxCells& cells)
      : band_(band), budget_(budget), cells_(cells) {}

  void choose(const Patch& patch, const MeshPosition& position) { choose(patch, position, 0, nullptr); }

 private:
  void choose(const Patch& patch, const MeshPosition& position, int depth, const LinearIrradiance* plane);
  void choose(BoxMesh& of, const MeshSquare& square, const LinearIrradiance* plane);
  [[nodiscard]] bool wants_finer_mesh(const BoxMesh& in, const MeshSquare& square, bool uses_common_plane) const;

  const BandContext& band_;
  CellBudget& budget_;
  BoxCells& cells_;
};

}  // namespace contrejour::inline internal::adaptive
