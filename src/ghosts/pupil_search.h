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

// None when nothing gets through. Differs: hullin2011 precomputes tables over light directions; packets are
// quick enough to search for every light anew.
[[nodiscard]] std::optional<PupilRegion> find_pupil_region(const OpticalPath& path, const ReflectanceTables& tables,
                                                           const IrisShape& iris, Vec3 direction,
                                                           const EntranceWindow& window, RayGrid& scratch);

}  // namespace contrejour
