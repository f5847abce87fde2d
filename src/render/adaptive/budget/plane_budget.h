// SPDX-License-Identifier: Apache-2.0
// This budget decides whether one plane for several cells of a mesh saves enough work and is as good as a plane for
// each cell.
#pragma once

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/visible_faults.h"
#include "render/adaptive/cells/cell_plane.h"

namespace contrejour::inline internal::adaptive {

inline constexpr double kWorthPlane_px = 1000.0;  // minimum area of a plane: smaller ones save few sides between cells

[[nodiscard]] inline bool serves(const IrradiancePlane& plane, double peak, double cell_budget) {
  constexpr double kPlane = 0.02;  // fraction of a cell's budget that the plane may leave
  constexpr double kMaxPlaneResidual = 0.1;  // largest RMS residual over the plane's mean, whatever the budget
  if (plane.area_px < kWorthPlane_px) return false;
  const double visible = peak_limited_weight(plane.mean, peak);
  const double plane_residual = plane.squared_error / plane.area_px;
  return plane.squared_error * visible * visible <= kPlane * cell_budget &&
         plane_residual <= kMaxPlaneResidual * kMaxPlaneResidual * plane.mean * plane.mean &&
         !shows_facets(plane.area_px, plane.mean, plane_residual, peak);
}

}  // namespace contrejour::inline internal::adaptive
