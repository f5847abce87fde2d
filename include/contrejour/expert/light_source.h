// SPDX-License-Identifier: Apache-2.0
// The position of a light: the ray that it sends through any point in front of a lens, and the flux along that ray.
// A distant light sends parallel rays; one at a finite distance is a point that sends its own ray through every point.
// A light a thousand kilometres away or more counts as distant: its rays' directions then differ by at most 1e-7.
// Flux (docs/physics/radiometry.md): an area dA of a plane perpendicular to the axis receives I cos(theta) dA / r^2. It
// is normalised to E0 = 1, where E0 = I / distance^2 is the light's normal irradiance at the first vertex.
// Thread-safety: a plain value.
#pragma once

#include <limits>

#include "contrejour/expert/vec.h"

namespace contrejour {

struct LightSource {
  static constexpr double kDistant_mm = 1e9;

  Vec3 direction{0, 0, 1};  // unit, from the light to the first vertex
  double distance_mm = std::numeric_limits<double>::infinity();  // from the light to the first vertex

  LightSource() = default;
  // A direction alone is a distant light.
  LightSource(Vec3 unit_direction, double distance = std::numeric_limits<double>::infinity())
      : direction(unit_direction), distance_mm(distance) {}

  [[nodiscard]] bool is_distant() const { return !(distance_mm < kDistant_mm); }
  [[nodiscard]] Vec3 point_mm() const { return direction * -distance_mm; }  // only if it is not distant

  [[nodiscard]] Vec3 direction_at(Vec3 point_mm) const {
    return is_distant() ? direction : normalized(point_mm + direction * distance_mm);
  }
  // Flux per mm^2 of a plane perpendicular to the axis is shared_flux() * flux_at(point).
  [[nodiscard]] double shared_flux() const { return is_distant() ? direction.z : 1.0; }
  [[nodiscard]] double flux_at(Vec3 point_mm) const {
    if (is_distant()) return 1.0;
    const Vec3 from_light = point_mm + direction * distance_mm;
    const double r = length(from_light);
    return (distance_mm / r) * (distance_mm / r) * (from_light.z / r);
  }

  friend bool operator==(const LightSource&, const LightSource&) = default;
};

}  // namespace contrejour
