// SPDX-License-Identifier: Apache-2.0
// The error of drawing a cell as one polygon with a linear irradiance: squared, summed over its pixels.
#pragma once

#include <optional>

#include "render/adaptive/budget/cell_measure.h"

namespace contrejour::inline internal::adaptive {

// The error of one cell, measured once and computed for either kind of sides.
class CellError {
 public:
  // All arguments must outlive this object. uses_common_plane: the cell's irradiance is that of a plane for several
  // cells.
  CellError(const BandContext& band, const Mesh& mesh, const Cell& cell, bool uses_common_plane)
      : band_(band), mesh_(mesh), cell_(cell), measure_(measure(band, mesh, cell, uses_common_plane)) {}

  // Infinite: the cell must not be drawn with these sides. cell_budget: the squared error that stands for a fault as
  // large as may be visible (visible_faults.h).
  [[nodiscard]] double squared(Sides sides, double cell_budget);

 private:
  [[nodiscard]] double irradiance_error(Sides sides, double width) const;
  [[nodiscard]] double along_edges(double visible, double displacement_px, double edges) const;
  [[nodiscard]] double pattern_error(double visible);

  const BandContext& band_;
  const Mesh& mesh_;
  const Cell& cell_;
  CellMeasure measure_;
  std::optional<double> map_error_;  // computed when needed
};

}  // namespace contrejour::inline internal::adaptive
