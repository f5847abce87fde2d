#include "contrejour/clear_aperture.h"

#include <algorithm>
#include <cmath>

namespace contrejour {
namespace {

// The farthest point of an ellipse or rectangle from the surface's axis, a little overstated for a decentred ellipse.
double reach_mm(const ClearAperture& a) {
  const double own = a.kind == ApertureKind::Rectangle ? length(a.half_mm) : std::max(a.half_mm.x, a.half_mm.y);
  return own + length(a.centre_mm);
}

}  // namespace

std::vector<Rim> rims_of(const ClearAperture& aperture, double semi_diameter_mm) {
  if (aperture.kind == ApertureKind::Disc) return {};
  const Vec2 x{std::cos(aperture.turn_rad), std::sin(aperture.turn_rad)};
  const Vec2 y{-x.y, x.x};
  const Vec2 u = x * (1.0 / aperture.half_mm.x), v = y * (1.0 / aperture.half_mm.y);
  std::vector<Rim> rims;
  if (aperture.kind == ApertureKind::Ellipse) {
    rims.push_back({aperture.centre_mm, u, v});
  } else {
    rims.push_back({aperture.centre_mm, u, {}});
    rims.push_back({aperture.centre_mm, v, {}});
  }
  if (reach_mm(aperture) > semi_diameter_mm) {
    const double per_mm = 1.0 / semi_diameter_mm;
    rims.push_back({{}, {per_mm, 0.0}, {0.0, per_mm}});
  }
  return rims;
}

}  // namespace contrejour
