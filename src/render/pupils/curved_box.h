// SPDX-License-Identifier: Apache-2.0
// Boxes of the entrance plane with one curved side, which follows the failing rays next to a pupil. A rim far off the
// axis is an arc there, and rays slightly beyond it miss a surface or are totally reflected: a box with straight sides
// around the light contains such rays, through which no polynomial can be fitted. A side curved by y^2 and y^4 avoids
// them, and keeps the box symmetric about the meridian.
#pragma once

#include <optional>
#include <span>

#include "render/pupils/clearance_grid.h"

namespace contrejour::inline internal::pupils {

// The distance of a curved side from the straight one, along x: by_y2 y^2 + by_y4 y^4, mm.
struct Side {
  double by_y2 = 0.0, by_y4 = 0.0;
  friend bool operator==(const Side&, const Side&) = default;
  [[nodiscard]] double at(double y_mm) const { return (by_y2 + by_y4 * y_mm * y_mm) * y_mm * y_mm; }
};

// The map from a box to the entrance plane, a displacement along x: that of the sides at low_mm and high_mm, linear
// between.
struct SideCurve {
  double low_mm = 0.0, high_mm = 1.0;
  Side low, high;

  [[nodiscard]] bool is_curved() const { return !(low == Side{} && high == Side{}); }
  // mm of the entrance plane per mm of the box, both along x.
  [[nodiscard]] double jacobian_x(double y_mm) const {
    return 1.0 + (high.at(y_mm) - low.at(y_mm)) / (high_mm - low_mm);
  }
  [[nodiscard]] double entrance_x(Vec2 in_box) const {
    return in_box.x + low.at(in_box.y) + (in_box.x - low_mm) * (jacobian_x(in_box.y) - 1.0);
  }
  [[nodiscard]] double box_x(Vec2 entrance) const {
    return low_mm + (entrance.x - low_mm - low.at(entrance.y)) / jacobian_x(entrance.y);
  }
};

struct CurvedBox {
  Rectangle box;
  SideCurve curve;
};

// Finds for a box about the meridian the least curved box that contains the light of all wavelengths and no failing
// ray, by a grid of 845 rays for each wavelength. None if there is none.
[[nodiscard]] std::optional<CurvedBox> curved_box(std::span<ClearanceGrid> wavelengths, const Rectangle& box);

}  // namespace contrejour::inline internal::pupils
