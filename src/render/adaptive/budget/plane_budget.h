// SPDX-License-Identifier: Apache-2.0
// Whether one plane for several cells of a mesh saves enough work and is as good as a plane for each cell.
#pragma once

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/visible_faults.h"
#include "render/adaptive/cells/cell_plane.h"

namespace contrejour::inline internal::adaptive {

inline constexpr double kWorthPlane_px = 1000.0;  // minimum area of a plane: smaller ones save few sides between cells

[[nodiscard]] inline bool serves(const IrradiancePlane& plane, double peak, double cell_budget) {
  constexpr double kPlane = 0.02;  // fraction of a cell's budget that the plane may leave
  constexpr double kPlaneOff = 0.1;  // largest RMS residual over the plane's mean, whatever the budget
  if (plane.area_px < kWorthPlane_px) return false;
  const double seen = seen_share(plane.mean, peak);
  const double off_plane = plane.squared_error / plane.area_px;
  return plane.squared_error * seen * seen <= kPlane * cell_budget &&
         off_plane <= kPlaneOff * kPlaneOff * plane.mean * plane.mean &&
         !shows_facets(plane.area_px, plane.mean, off_plane, peak);
}

}  // namespace contrejour::inline internal::adaptive
