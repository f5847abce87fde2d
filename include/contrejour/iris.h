// The opening of the aperture stop as a shape of unit circumradius in the stop plane.
// Accuracy: signed distances are exact for the circle, exact inside and near the edges of the polygon.
// Thread-safety: plain values.
#pragma once

#include "contrejour/vec.h"

namespace contrejour {

struct Iris {
  int blades = 0;             // 0 to 2: a full circle; 3 and more: a regular polygon
  double rotation_rad = 0.0;  // first corner, counter-clockwise from +x as the photographer sees it
  friend bool operator==(const Iris&, const Iris&) = default;
};

// Signed distance from the edge in units of the stop radius, negative inside.
// point: position in the stop plane divided by the stop radius.
[[nodiscard]] double iris_distance(const Iris& iris, Vec2 point);

// Area of the opening over the area of its circumscribed circle.
[[nodiscard]] double iris_area_fraction(const Iris& iris);

}  // namespace contrejour
