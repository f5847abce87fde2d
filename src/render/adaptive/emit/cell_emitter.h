// SPDX-License-Identifier: Apache-2.0
// Emits chosen cells as polygons: computes their light, has them clipped, and splits those that one polygon cannot
// represent.
#pragma once

#include <optional>
#include <vector>

#include "render/adaptive/budget/cell_budget.h"
#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/clip/cell_clipper.h"
#include "render/adaptive/emit/cell_light.h"
#include "render/adaptive/emit/cell_parts.h"
#include "render/adaptive/emit/polygon_emitter.h"

namespace contrejour::inline internal::adaptive {

class CellEmitter {
 public:
  // All arguments must outlive this object. cells: those that are emitted, joined.
  CellEmitter(const BandContext& band, const CellBudget& budget, const BoxCells& cells, PolygonList& out)
      : band_(band), budget_(budget), cells_(cells), clipper_(band), polygons_(band, out) {}

  void emit(const BoxMesh& of, const ChosenCell& chosen);

 private:
  void emit_parts(const Mesh& mesh, const Cell& cell, const CellParts& parts);
  void emit_folded(const Mesh& mesh, const Cell& cell, const std::optional<Flux>& mean);
  void emit_convex(const Mesh& mesh, const ChosenCell& chosen, const CellLight& light, const StopMap* map);
  void emit_dirty(const Mesh& mesh, const Cell& cell, const CellLight& light, const StopMap* map);
  void emit_outline(const Mesh& mesh, CellState state, const CellLight& light, const CellOutline& outline,
                    const Occluders& occluders);

  const BandContext& band_;
  const CellBudget& budget_;
  const BoxCells& cells_;
  CellClipper clipper_;
  PolygonEmitter polygons_;
  std::vector<CellCorner> all_corners_;  // of a cell
};

}  // namespace contrejour::inline internal::adaptive
