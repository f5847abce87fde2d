// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/clear_aperture.h"

#include <algorithm>
#include <cmath>

namespace contrejour {
namespace {

// Distance of an ellipse's or rectangle's farthest point from the surface's axis; an upper bound for a decentred
// ellipse.
double aperture_mm(const ClearAperture& a) {
  const double own = a.kind == ApertureKind::Rectangle ? length(a.half_mm) : std::max(a.half_mm.x, a.half_mm.y);
  return own + length(a.centre_mm);
}

Rim ellipse_of(Vec2 half_mm, Vec2 centre_mm, double rotation_rad) {
  const Vec2 x{std::cos(rotation_rad), std::sin(rotation_rad)};
  const Vec2 y{-x.y, x.x};
  return {centre_mm, x * (1.0 / half_mm.x), y * (1.0 / half_mm.y)};
}

}  // namespace

std::vector<Rim> rims_of(const ClearAperture& aperture, double semi_diameter_mm) {
  if (aperture.kind == ApertureKind::Disc) return {};
  const Rim ellipse = ellipse_of(aperture.half_mm, aperture.centre_mm, aperture.rotation_rad);
  std::vector<Rim> rims;
  if (aperture.kind == ApertureKind::Ellipse) {
    rims.push_back(ellipse);
  } else {
    rims.push_back({ellipse.centre_mm, ellipse.u_per_mm, {}});
    rims.push_back({ellipse.centre_mm, ellipse.v_per_mm, {}});
  }
  if (aperture_mm(aperture) > semi_diameter_mm) {
    const double per_mm = 1.0 / semi_diameter_mm;
    rims.push_back({{}, {per_mm, 0.0}, {0.0, per_mm}});
  }
  return rims;
}

Rim rim_of(const Obscuration& obscuration) {
  return ellipse_of(obscuration.half_mm, obscuration.centre_mm, obscuration.rotation_rad);
}

}  // namespace contrejour
