// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghosts_under.h"

#include <algorithm>
#include <cmath>

namespace contrejour::studio {
namespace {

constexpr double kSmallestReach_px = 3.0;  // a ghost in focus could not be hit otherwise

Vec2 reach_of(const GhostFigures& ghost) {
  return {std::fmax(0.5 * ghost.size_px.x, kSmallestReach_px), std::fmax(0.5 * ghost.size_px.y, kSmallestReach_px)};
}

double density(const GhostFigures& ghost) {
  const Vec2 reach = reach_of(ghost);
  return ghost.relative_flux / (reach.x * reach.y);
}

}  // namespace

std::vector<std::size_t> ghosts_under(const std::vector<GhostFigures>& figures, Vec2 point_px) {
  std::vector<std::size_t> under;
  for (std::size_t k = 0; k < figures.size(); ++k) {
    if (!(figures[k].relative_flux > 0)) continue;
    const Vec2 reach = reach_of(figures[k]);
    const Vec2 from = point_px - figures[k].centroid_px;
    if (std::hypot(from.x / reach.x, from.y / reach.y) <= 1.0) under.push_back(k);
  }
  std::sort(under.begin(), under.end(),
            [&](std::size_t a, std::size_t b) { return density(figures[a]) > density(figures[b]); });
  return under;
}

}  // namespace contrejour::studio
