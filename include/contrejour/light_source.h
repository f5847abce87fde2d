// The position of a light: the ray that it sends through any point in front of a lens, and the flux along that ray.
// A distant light sends parallel rays; one at a finite distance is a point that sends its own ray through every point.
// From a thousand kilometres on it counts as distant: no two rays then differ by more than 1e-7.
// Flux (docs/physics/radiometry.md): a patch dA of a plane perpendicular to the axis takes in I cos(theta) dA / r^2. It
// is given at E0 = 1, the normal irradiance that the light has at the first vertex, I / distance^2.
// Thread-safety: a plain value.
#pragma once

#include <limits>

#include "contrejour/vec.h"

namespace contrejour {

struct LightSource {
  static constexpr double kDistant_mm = 1e9;

  Vec3 direction{0, 0, 1};  // unit, from the light to the first vertex
  double distance_mm = std::numeric_limits<double>::infinity();  // likewise

  LightSource() = default;
  // A direction alone is a distant light.
  LightSource(Vec3 unit_direction, double distance = std::numeric_limits<double>::infinity())
      : direction(unit_direction), distance_mm(distance) {}

  [[nodiscard]] bool is_distant() const { return !(distance_mm < kDistant_mm); }
  [[nodiscard]] Vec3 point_mm() const { return direction * -distance_mm; }  // of one that is not distant

  [[nodiscard]] Vec3 direction_at(Vec3 point_mm) const {
    return is_distant() ? direction : normalized(point_mm + direction * distance_mm);
  }
  // Flux per mm^2 of a plane perpendicular to the axis: the product of a common factor and one for each point.
  [[nodiscard]] double shared_flux() const { return is_distant() ? direction.z : 1.0; }
  [[nodiscard]] double flux_at(Vec3 point_mm) const {
    if (is_distant()) return 1.0;
    const Vec3 way = point_mm + direction * distance_mm;
    const double r = length(way);
    return (distance_mm / r) * (distance_mm / r) * (way.z / r);
  }

  friend bool operator==(const LightSource&, const LightSource&) = default;
};

}  // namespace contrejour
