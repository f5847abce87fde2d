// SPDX-License-Identifier: Apache-2.0
// Clips the outline of a cell, or of a triangle of its vertices, to what the iris and the rims leave open.
#pragma once

#include <span>
#include <vector>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/clip/outline_cutter.h"

namespace contrejour::inline internal::adaptive {

struct CellOutline {
  std::span<const CellCorner> shape;  // the corners, and the middles of sides that bend; or three corners
  std::span<const CellCorner> all;    // the same, and corners of finer meshes on the sides
};

class CellClipper {
 public:
  // band must outlive this object.
  explicit CellClipper(const BandContext& band) : band_(band), cutter_(band.iris) {}

  // Whether for_each_open_part() is needed in place of open_part().
  [[nodiscard]] bool by_picture(CellState state) const {
    return state == CellState::Cut && band_.iris.is_picture() && !band_.pattern;
  }
  // Whether open_part() needs an arc step.
  [[nodiscard]] bool by_arcs(CellState state) const { return state == CellState::Cut && !band_.pattern; }

  // The open part in pixels of the frame; the whole outline if the cell is not cut. Empty if nothing is open. Valid
  // until the next call. arc_step_rad: as in OutlineCutter.
  [[nodiscard]] std::span<const Corner> open_part(const Mesh& mesh, CellState state, const CellOutline& of,
                                                  double arc_step_rad);
  // Where the iris is a picture: visits convex parts, each with its transmittance. Details that no pixel shows are
  // averaged.
  void for_each_open_part(const Mesh& mesh, const CellOutline& of, const OutlineCutter::OpenPart& visit);

 private:
  const BandContext& band_;
  OutlineCutter cutter_;
  std::vector<Corner> shape_, outline_;  // scratch
};

}  // namespace contrejour::inline internal::adaptive
