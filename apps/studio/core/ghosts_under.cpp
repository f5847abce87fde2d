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

bool is_in_ellipse(const GhostFigures& ghost, Vec2 point_px) {
  const Vec2 reach = reach_of(ghost), from = point_px - ghost.centroid_px;
  return std::hypot(from.x / reach.x, from.y / reach.y) <= 1.0;
}

}  // namespace

std::vector<std::size_t> ghosts_under(const std::vector<GhostFigures>& figures, Vec2 point_px,
                                      std::span<const GhostFootprint> footprints) {
  std::vector<std::size_t> under;
  for (std::size_t k = 0; k < figures.size(); ++k) {
    if (!(figures[k].relative_flux > 0)) continue;
    const bool is_traced = k < footprints.size() && !footprints[k].cells_px.empty();
    const bool is_there =
        is_traced ? footprints[k].contains(point_px, kSmallestReach_px) : is_in_ellipse(figures[k], point_px);
    if (is_there) under.push_back(k);
  }
  std::sort(under.begin(), under.end(),
            [&](std::size_t a, std::size_t b) { return density(figures[a]) > density(figures[b]); });
  return under;
}

}  // namespace contrejour::studio
