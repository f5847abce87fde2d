// SPDX-License-Identifier: Apache-2.0
// Turns patches into polygons, in stages that share a BandContext: choose cells by their errors (choose, budget), clip
// them (clip), emit polygons (emit).
#pragma once

#include <memory>
#include <utility>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "render/adaptive/budget/cell_budget.h"
#include "render/adaptive/budget/tolerance.h"
#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/choose/cell_chooser.h"
#include "render/adaptive/emit/cell_emitter.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

class Tessellator {
 public:
  // budget: of each band. few_cells: as in CellBudget. cells: scratch memory.
  Tessellator(const IrisShape& iris, const Frame& frame, const ErrorBudget& budget, double few_cells, BoxCells& cells,
              PolygonList& out)
      : cells_(cells), budget_(budget.squared_error, few_cells), band_{iris, frame.width, frame.height, budget.peak},
        chooser_(band_, budget_, cells_), emitter_(band_, budget_, cells_, out) {}
  Tessellator(const Tessellator&) = delete;
  Tessellator& operator=(const Tessellator&) = delete;

  // Chooses the cells of a patch at this position in its box; emit() then emits all cells chosen for a band.
  void choose(const Patch& patch, const MeshPosition& position) { chooser_.choose(patch, position); }
  void emit();

  // These hold for the patches that follow. has_curved_sides: as in BandContext.
  void set_curved_sides(bool has_curved_sides) { band_.has_curved_sides = has_curved_sides; }
  // unit: of the patches' stop coordinates, in stop radii.
  void set_stop_pattern(std::shared_ptr<const stop_patterns::BandStopPattern> pattern, double unit);
  void set_dirt(const DirtView& dirt) { band_.dirt = dirt; }
  // Once it is cancelled, emit() leaves cells out: those under dirt may take tenths of a second. Null: never.
  void stop_with(const Context* context) { context_ = context; }

 private:
  BoxCells& cells_;
  CellBudget budget_;
  BandContext band_;
  CellChooser chooser_;
  CellEmitter emitter_;
  const Context* context_ = nullptr;
};

}  // namespace contrejour::inline internal::adaptive
