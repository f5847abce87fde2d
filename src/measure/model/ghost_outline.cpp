// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/ghost_outline.h"

#include <algorithm>

#include "measure/model/outline_cubic.h"
#include "measure/model/outline_distance.h"

namespace contrejour {

OutlinePoint nearest_point(const GhostOutline& outline, Vec2 point) { return OutlineDistance(outline).nearest(point); }

std::array<double, kOutlineParameters> distance_gradient(const GhostOutline& outline, const OutlinePoint& nearest) {
  if (nearest.is_on_clip) return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -nearest.normal.x, -1.0};
  const Vec2 normal{nearest.normal.x, nearest.is_below ? -nearest.normal.y : nearest.normal.y};
  const std::array<Vec2, kCubicParameters> moved =
      nearest.is_right ? right_derivatives(outline, nearest.t) : left_derivatives(outline, nearest.t);
  std::array<double, kOutlineParameters> gradient{};
  std::transform(moved.begin(), moved.end(), gradient.begin(), [&](Vec2 by) { return -dot(normal, by); });
  return gradient;
}

}  // namespace contrejour
