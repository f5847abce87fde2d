// Where on the entrance plane a path's light gets through, and integrals over that region.
#pragma once

#include <functional>
#include <optional>

#include "contrejour/trace.h"

namespace contrejour {

struct PupilBox {
  Vec2 min_mm, max_mm;
};

// A box that encloses the unblocked region of a path for one light; none when nothing gets through. Found by
// zooming in on the cells of a coarse grid that are open or may be, so regions far smaller than a cell of the
// first grid are found too.
[[nodiscard]] std::optional<PupilBox> find_pupil(const OpticalPath& path, const Iris& iris, Vec3 direction,
                                                 const EntranceWindow& window);

// A triangle of entrance points, with its share that is unblocked.
struct PupilTriangle {
  const TracedRay* ray[3];
  Vec2 point_mm[3];
  double open_fraction = 0;
  double area_mm2 = 0;  // whole, on the entrance plane
};

// Visits the triangles of a cells x cells grid over the box, those with an open part and three traced rays.
void for_each_open_triangle(const OpticalPath& path, const Iris& iris, Vec3 direction, double z_mm,
                            const PupilBox& box, int cells, const std::function<void(const PupilTriangle&)>& visit);

}  // namespace contrejour
