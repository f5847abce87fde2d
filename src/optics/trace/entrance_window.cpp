#include <algorithm>
#include <cmath>

#include "contrejour/trace.h"

namespace contrejour {
namespace {

constexpr int kRings = 64;          // of the cap, from vertex to rim
constexpr double kMargin = 1e-3;    // of the semi-diameter: the rings' own discretisation

double sag(double curvature, double r) {
  const double cr = curvature * r;
  return curvature * r * r / (1.0 + std::sqrt(std::max(0.0, 1.0 - cr * cr)));
}

}  // namespace

// The cap of surface 1, seen along the light, is more than its rim when the light comes in obliquely onto a
// bulging surface: each ring of the cap is projected along the light onto the plane of the rim.
EntranceWindow entrance_window(const LensState& lens, Vec3 direction) {
  const SurfaceState& first = lens.surfaces.front();
  const double rim = first.semi_diameter_mm;
  const Vec2 slope{direction.x / direction.z, direction.y / direction.z};
  EntranceWindow window;
  window.z_mm = first.z_mm + sag(first.curvature_per_mm, rim);
  window.min_mm = {-rim, -rim};
  window.max_mm = {rim, rim};
  for (int k = 0; k <= kRings; ++k) {
    const double r = rim * k / kRings;
    const Vec2 shift = slope * (window.z_mm - (first.z_mm + sag(first.curvature_per_mm, r)));
    window.min_mm = {std::min(window.min_mm.x, shift.x - r), std::min(window.min_mm.y, shift.y - r)};
    window.max_mm = {std::max(window.max_mm.x, shift.x + r), std::max(window.max_mm.y, shift.y + r)};
  }
  const Vec2 margin{kMargin * rim, kMargin * rim};
  window.min_mm = window.min_mm - margin;
  window.max_mm = window.max_mm + margin;
  return window;
}

}  // namespace contrejour
