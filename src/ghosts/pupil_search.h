// hullin2011 4.2, ray bounding: the rectangle of the entrance plane that encloses every ray of a ghost that
// gets through, found by tracing coarse grids.
#pragma once

#include <cstdint>
#include <optional>

#include "ghosts/ray_grid.h"

namespace contrejour {

struct PupilRegion {
  Rectangle pupil_mm;   // enclosing, with a margin
  Rectangle sensor_mm;  // where its rays land, about
  std::uint64_t rays = 0;
};

// How far to look where the first grid meets nothing. A fisheye lets some ghosts through a thousandth of its front.
enum class PupilEffort {
  Once,      // not at all
  Finer,     // a grid of four times as many rays a side
  Finest,    // and one of twelve times
};
inline constexpr int kSearchSide = 49;  // rays a side of a search's grids, where nobody asks for less
[[nodiscard]] int first_grid_side(PupilEffort effort);  // rays a side of the finest of them
// For a ghost that is to be drawn by so many rays a side, so that searching costs in proportion to drawing.
[[nodiscard]] PupilEffort effort_for_grid(int side);

// None when nothing gets through. Differs: hullin2011 precomputes tables over light directions (pupil_bounds.h);
// packets are quick enough to search for every light anew. A side below kSearchSide is for well-behaved paths.
[[nodiscard]] std::optional<PupilRegion> find_pupil_region(const OpticalPath& path, const ReflectanceTables& tables,
                                                           const IrisShape& iris, const LightSource& light,
                                                           const EntranceWindow& window, RayGrid& scratch,
                                                           PupilEffort effort = PupilEffort::Finest,
                                                           int side = kSearchSide);

// The same by one coarse grid over a guess. None when the guess holds no ray that gets through, or cuts some off.
[[nodiscard]] std::optional<PupilRegion> find_pupil_region_in(const Rectangle& guess, const OpticalPath& path,
                                                              const ReflectanceTables& tables, const IrisShape& iris,
                                                              const LightSource& light, const EntranceWindow& window,
                                                              RayGrid& scratch);

}  // namespace contrejour
