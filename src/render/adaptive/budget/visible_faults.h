// SPDX-License-Identifier: Apache-2.0
// Faults that show in bright ghosts, however small their error is relative to the peak: facets, seams and corners.
#pragma once

namespace contrejour::inline internal::adaptive {

// In a cell larger than kFacet_px and brighter than kFacetLevel of the peak, a plane that is off by more than kFacet of
// the mean shows as a facet.
inline constexpr double kFacet = 0.02, kFacet_px = 400.0, kFacetLevel = 2e-4;

// plane_residual: mean square residual of the plane.
[[nodiscard]] inline bool shows_facets(double area_px, double mean, double plane_residual, double peak) {
  return area_px > kFacet_px && mean > kFacetLevel * peak && plane_residual > kFacet * kFacet * mean * mean;
}

// Limits for cells longer than kShownLength_px in ghosts brighter than kFacetLevel. A gap wider than kSeam_px shows as
// a line where a side, curved only by the shape of its box, meets a cell of another box. An edge that crosses a side
// more than kCorner_px from its true position shows a corner.
inline constexpr double kShownLength_px = 8.0, kSeam_px = 0.07, kCorner_px = 1.0;

// The largest distance of chords from their arc, whatever the budget: in ghosts brighter than kFacetLevel larger ones
// show corners.
inline constexpr double kMaxChordDistance_px = 0.5, kMaxVisibleChordDistance_px = 0.25;

}  // namespace contrejour::inline internal::adaptive
