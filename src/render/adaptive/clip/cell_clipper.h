// SPDX-License-Identifier: Apache-2.0
// Clips the outline of a cell, or of a triangle of its vertices, to what the iris and the rims leave open.
#pragma once

#include <span>
#include <vector>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/clip/polygon_clipper.h"

namespace contrejour::inline internal::adaptive {

struct CellOutline {
  std::span<const CellCorner> shape;  // the corners, and the middles of sides that are curved; or three corners
  std::span<const CellCorner> all;    // the same, and corners of finer meshes on the sides
};

class CellClipper {
 public:
  // band must outlive this object.
  explicit CellClipper(const BandContext& band) : band_(band), polygon_clipper_(band.iris) {}

  // Returns whether for_each_open_part() is needed in place of open_part().
  [[nodiscard]] bool by_picture(CellState state) const {
    return state == CellState::Clipped && band_.iris.is_picture() && !band_.pattern;
  }
  // Returns whether open_part() needs an arc step.
  [[nodiscard]] bool by_arcs(CellState state) const { return state == CellState::Clipped && !band_.pattern; }

  // The open part in pixels of the frame; the whole outline if the cell is not cut. Empty if nothing is open. Valid
  // until the next call. arc_step_rad: as in PolygonClipper.
  [[nodiscard]] std::span<const Corner> open_part(const Mesh& mesh, CellState state, const CellOutline& of,
                                                  double arc_step_rad);
  // For a picture as the iris: visits convex parts, each with its transmittance. Details that no pixel shows are
  // averaged.
  void for_each_open_part(const Mesh& mesh, const CellOutline& of, const PolygonClipper::OpenPart& visit);

 private:
  const BandContext& band_;
  PolygonClipper polygon_clipper_;
  std::vector<Corner> shape_, outline_;  // scratch
};

}  // namespace contrejour::inline internal::adaptive
