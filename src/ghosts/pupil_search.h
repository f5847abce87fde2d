// SPDX-License-Identifier: Apache-2.0
// hullin2011 4.2, ray bounding: the rectangle of the entrance plane that encloses every ray of a ghost that
// gets through, found by tracing coarse grids.
#pragma once

#include <cstdint>
#include <optional>

#include "ghosts/ray_grid.h"

namespace contrejour::inline internal {

struct PupilRegion {
  Rectangle pupil_mm;   // enclosing, with a margin
  Rectangle sensor_mm;  // approximate bounds of its rays on the sensor
  std::uint64_t rays = 0;
};

// The grids that are tried if the first one finds nothing. Some ghosts of a fisheye get through a thousandth of its
// front.
enum class PupilEffort {
  Once,      // not at all
  Finer,     // a grid of four times as many rays a side
  Finest,    // and one of twelve times
};
inline constexpr int kSearchSide = 49;  // default of the rays along a side of a search's grids
[[nodiscard]] int first_grid_side(PupilEffort effort);  // rays a side of the effort's finest grid
// The effort for a ghost that is drawn with this number of rays a side, so that searching costs in proportion to
// drawing.
[[nodiscard]] PupilEffort effort_for_grid(int side);

// None when nothing gets through. Differs: hullin2011 precomputes tables over light directions (pupil_bounds.h);
// packets are fast enough to search anew for every light. A side below kSearchSide is for well-behaved paths.
[[nodiscard]] std::optional<PupilRegion> find_pupil_region(const OpticalPath& path, const ReflectanceTables& tables,
                                                           const IrisShape& iris, const LightSource& light,
                                                           const EntranceWindow& window, RayGrid& scratch,
                                                           PupilEffort effort = PupilEffort::Finest,
                                                           int side = kSearchSide);

// The same with one coarse grid over a guess. None if no ray in the guess gets through, or if the pupil extends beyond
// it.
[[nodiscard]] std::optional<PupilRegion> find_pupil_region_in(const Rectangle& guess, const OpticalPath& path,
                                                              const ReflectanceTables& tables, const IrisShape& iris,
                                                              const LightSource& light, const EntranceWindow& window,
                                                              RayGrid& scratch);

}  // namespace contrejour::inline internal
