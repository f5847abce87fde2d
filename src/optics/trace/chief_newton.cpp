// SPDX-License-Identifier: Apache-2.0
#include "optics/trace/chief_newton.h"

namespace contrejour::inline internal {

std::optional<ChiefRay> aim_chief(const OpticalPath& path, const LightSource& source, Vec2 at_mm) {
  constexpr double kStep_mm = 1e-4;
  const auto ray = [&](Vec2 at) {
    const Vec3 from{at.x, at.y, 0.0};
    return trace(path, {from, source.direction_at(from)});
  };
  for (int k = 0; k < kAimSteps; ++k) {
    const TracedRay here = ray(at_mm);
    const TracedRay right = ray(at_mm + Vec2{kStep_mm, 0.0});
    const TracedRay up = ray(at_mm + Vec2{0.0, kStep_mm});
    if (here.status != RayStatus::Ok || right.status != RayStatus::Ok || up.status != RayStatus::Ok)
      return std::nullopt;
    const Vec2 stop = here.stop[0];
    if (length(stop) < kAimed) return ChiefRay{at_mm, here.sensor_mm};
    const Vec2 dx = (right.stop[0] - stop) * (1.0 / kStep_mm);
    const Vec2 dy = (up.stop[0] - stop) * (1.0 / kStep_mm);
    const double area = cross(dx, dy);
    if (area == 0.0) return std::nullopt;
    at_mm = at_mm - Vec2{cross(stop, dy) / area, cross(dx, stop) / area};
  }
  return std::nullopt;
}

}  // namespace contrejour::inline internal
