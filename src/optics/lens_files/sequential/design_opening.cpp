// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_opening.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optics/lens/rims.h"

namespace contrejour::inline internal {
namespace {

// The largest radius, up to this one, at which the surface exists.
double reached_mm(const Surface& surface, double max_mm) {
  if (reaches(surface, max_mm)) return max_mm;
  constexpr int kBisections = 50;
  double low = 0.0, high = max_mm;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    (reaches(surface, middle) ? low : high) = middle;
  }
  return low;
}

Vec2 rotated(double rotation_rad, Vec2 at) {
  if (rotation_rad == 0.0) return at;
  const double c = std::cos(rotation_rad), s = std::sin(rotation_rad);
  return {c * at.x - s * at.y, s * at.x + c * at.y};
}

}  // namespace

void set_opening(const DesignSurface& from, double unit_mm, Surface& surface, std::vector<std::string>& warnings) {
  surface.semi_diameter_mm = from.semi_diameter * unit_mm;
  if (from.obscuration.any())
    surface.obscuration = {from.obscuration.half_mm * unit_mm, from.obscuration.centre_mm * unit_mm,
                           from.obscuration.rotation_rad};
  if (!from.opening) return;
  const DesignOpening& opening = *from.opening;
  if (!(opening.half_x > 0.0 && opening.half_y > 0.0)) {
    if (opening.circle > 0.0) surface.semi_diameter_mm = opening.circle * unit_mm;
    return;
  }
  const bool rectangle = opening.shape == OpeningShape::Rectangle;
  const bool disc = !rectangle && opening.half_x == opening.half_y && opening.centre == Vec2{};
  if (!disc) {
    surface.aperture.kind = rectangle ? ApertureKind::Rectangle : ApertureKind::Ellipse;
    surface.aperture.half_mm = Vec2{opening.half_x, opening.half_y} * unit_mm;
    surface.aperture.centre_mm = opening.centre * unit_mm;
    surface.aperture.rotation_rad = opening.rotation_rad;
  }
  const double own = rectangle ? std::hypot(opening.half_x, opening.half_y) : std::max(opening.half_x, opening.half_y);
  double semi_mm = (own + length(opening.centre)) * unit_mm;
  if (opening.circle > 0.0) semi_mm = std::min(semi_mm, opening.circle * unit_mm);
  surface.semi_diameter_mm = reached_mm(surface, semi_mm);
  if (surface.semi_diameter_mm < semi_mm)
    warnings.push_back(
        fmt::format("the aperture (line {}) goes on where the surface ends; a circle of {:.6g} mm radius "
                    "cuts it",
                    opening.line, surface.semi_diameter_mm));
}

void rotate_opening(double rotation_rad, ClearAperture& aperture) {
  if (aperture.kind == ApertureKind::Disc) return;
  aperture.rotation_rad += rotation_rad;
  aperture.centre_mm = rotated(rotation_rad, aperture.centre_mm);
}

void rotate_opening(double rotation_rad, Obscuration& obscuration) {
  if (obscuration.half_mm.x != obscuration.half_mm.y) obscuration.rotation_rad += rotation_rad;
  obscuration.centre_mm = rotated(rotation_rad, obscuration.centre_mm);
}

}  // namespace contrejour::inline internal
