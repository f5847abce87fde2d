// SPDX-License-Identifier: Apache-2.0
// The quantities from which the error of drawing a cell as one polygon is computed.
#pragma once

#include <optional>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/cell.h"

namespace contrejour::inline internal::adaptive {

// They hold for straight and for curved sides.
struct CellMeasure {
  bool uses_common_plane = false;        // its irradiance is that of a plane for several cells
  std::optional<double> total;  // the squared error whatever its sides are; infinite: do not draw the cell
  double max_error = 0.0;            // the largest possible squared error
  double mean = 0.0, range = 0.0;     // RMS irradiance of the channels, and its range
  double plane_residual = 0.0;             // mean square residual of a plane through it
  double area_px = 0.0;               // by the derivatives in its middle
  double image_px = 0.0, flux = 0.0;  // integrals over the cell
  double longest_px = 0.0;
  double limit = 0.0;  // limit_error()
};

// uses_common_plane: the cell's irradiance is that of a plane for several cells.
[[nodiscard]] CellMeasure measure(const BandContext& band, const Mesh& mesh, const Cell& cell, bool uses_common_plane);

}  // namespace contrejour::inline internal::adaptive
