// Boxes of the entrance plane one side of which bends with what fails beside a pupil. A rim far off the axis is an arc
// there, and rays a little beyond it miss a surface or are reflected totally: a box with straight sides that holds the
// light holds such rays, through which no polynomial goes. Bent along y^2 and y^4 it need not, and stays symmetric
// about the meridian.
#pragma once

#include <optional>
#include <span>

#include "ghosts/pupils/clearance_grid.h"

namespace contrejour::pupils {

// How far a side lies from where a straight one would, along x: by_y2 y^2 + by_y4 y^4, mm.
struct Side {
  double by_y2 = 0.0, by_y4 = 0.0;
  friend bool operator==(const Side&, const Side&) = default;
  [[nodiscard]] double at(double y_mm) const { return (by_y2 + by_y4 * y_mm * y_mm) * y_mm * y_mm; }
};

// From a box to the entrance plane, along x alone: as far as its sides at low_mm and high_mm, in proportion between.
struct Bend {
  double low_mm = 0.0, high_mm = 1.0;
  Side low, high;

  [[nodiscard]] bool is_bent() const { return !(low == Side{} && high == Side{}); }
  // mm of the entrance plane per mm of the box, both along x.
  [[nodiscard]] double stretch(double y_mm) const { return 1.0 + (high.at(y_mm) - low.at(y_mm)) / (high_mm - low_mm); }
  [[nodiscard]] double entrance_x(Vec2 in_box) const {
    return in_box.x + low.at(in_box.y) + (in_box.x - low_mm) * (stretch(in_box.y) - 1.0);
  }
  [[nodiscard]] double box_x(Vec2 entrance) const {
    return low_mm + (entrance.x - low_mm - low.at(entrance.y)) / stretch(entrance.y);
  }
};

struct BentBox {
  Rectangle box;
  Bend bend;
};

// Of a box about the meridian: the least bent one that holds the light of all wavelengths and no ray that fails, as far
// as grids of 845 rays tell, one a wavelength. None where there is none.
[[nodiscard]] std::optional<BentBox> bent_box(std::span<ClearanceGrid> wavelengths, const Rectangle& box);

}  // namespace contrejour::pupils
