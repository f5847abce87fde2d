// SPDX-License-Identifier: Apache-2.0
#include "optics/lens/build_errors.h"

#include <cmath>

#include <fmt/format.h>

#include "base/normal_pair.h"
#include "optics/lens/carried.h"

namespace contrejour::inline internal {
namespace {

constexpr double kMaxDecentre_mm = 100.0;

// Surfaces first to last with glass between, the stop among them or not.
struct Body {
  std::size_t first = 0, last = 0;
};

std::vector<Body> bodies_of(const std::vector<SurfaceState>& surfaces) {
  std::vector<Body> bodies;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (is_air(surfaces[k].after)) continue;
    Body body{k, k};
    while (body.last + 1 < surfaces.size() && !is_air(surfaces[body.last].after)) ++body.last;
    bodies.push_back(body);
    k = body.last;
  }
  return bodies;
}

Vec3 tilted_axis(Vec2 tilt_rad) {
  const double angle = std::min(length(tilt_rad), BuildErrors::kMaxTilt_rad);
  if (angle == 0.0) return {0, 0, 1};
  const Vec2 towards = tilt_rad * (std::sin(angle) / length(tilt_rad));
  return {towards.x, towards.y, std::cos(angle)};
}

}  // namespace

Result<void> check_build_errors(const BuildErrors& errors) {
  if (!(errors.tilt_rms_rad >= 0.0 && errors.tilt_rms_rad <= BuildErrors::kMaxTilt_rad))
    return failure(ErrorCode::InvalidArgument, fmt::format("a tilt of {} rad is out of range; choose 0 to {}",
                                                           errors.tilt_rms_rad, BuildErrors::kMaxTilt_rad));
  if (!(errors.decentre_rms_mm >= 0.0 && errors.decentre_rms_mm <= kMaxDecentre_mm))
    return failure(ErrorCode::InvalidArgument, fmt::format("a decentre of {} mm is out of range; choose 0 to {}",
                                                           errors.decentre_rms_mm, kMaxDecentre_mm));
  return {};
}

void apply_build_errors(const BuildErrors& errors, std::vector<SurfaceState>& surfaces) {
  if (errors.tilt_rms_rad == 0.0 && errors.decentre_rms_mm == 0.0) return;
  std::uint32_t index = 0;
  for (const Body& body : bodies_of(surfaces)) {
    const Vec3 axis = tilted_axis(normal_pair({errors.seed, index, 0}) * errors.tilt_rms_rad);
    const Vec2 decentre = normal_pair({errors.seed, index, 1}) * errors.decentre_rms_mm;
    ++index;
    const double middle_mm = 0.5 * (surfaces[body.first].z_mm + surfaces[body.last].z_mm);
    for (std::size_t k = body.first; k <= body.last; ++k) {
      SurfaceState& s = surfaces[k];
      if (s.kind == SurfaceKind::Stop) continue;
      s.pose = carried({Vec3{decentre.x, decentre.y, 0.0}, axis}, s.z_mm - middle_mm, s.pose);
    }
  }
}

}  // namespace contrejour::inline internal
