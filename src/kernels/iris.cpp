#include "contrejour/iris.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour {

double iris_distance(const Iris& iris, Vec2 point) {
  if (iris.blades < 3) return length(point) - 1.0;
  // Fold the point into the sector of one edge; its distance to that edge's line is the distance to the
  // polygon inside and beside the edge, and within 1 / cos(pi / n) of it beyond a corner.
  const double sector = 2.0 * std::numbers::pi / iris.blades;
  const double angle = std::atan2(point.y, point.x) - iris.rotation_rad;
  const double folded = angle - sector * std::floor(angle / sector) - 0.5 * sector;
  return length(point) * std::cos(folded) - std::cos(0.5 * sector);
}

double iris_area_fraction(const Iris& iris) {
  if (iris.blades < 3) return 1.0;
  const double sector = 2.0 * std::numbers::pi / iris.blades;
  return std::sin(sector) / sector;
}

}  // namespace contrejour
