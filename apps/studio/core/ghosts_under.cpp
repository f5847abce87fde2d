// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghosts_under.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace contrejour::studio {
namespace {

constexpr double kSmallestReach_px = 3.0;  // a ghost in focus could not be hit otherwise

Vec2 reach_of(const GhostFigures& ghost) {
  return {std::fmax(0.5 * ghost.size_px.x, kSmallestReach_px), std::fmax(0.5 * ghost.size_px.y, kSmallestReach_px)};
}

bool is_in_ellipse(const GhostFigures& ghost, Vec2 point_px) {
  const Vec2 reach = reach_of(ghost), from = point_px - ghost.centroid_px;
  return std::hypot(from.x / reach.x, from.y / reach.y) <= 1.0;
}

// None if the ghost is not there.
std::optional<double> irradiance(const GhostFigures& ghost, const GhostFootprint* footprint, Vec2 point_px) {
  if (footprint != nullptr && !footprint->cells_px.empty()) {
    if (!footprint->contains(point_px, kSmallestReach_px)) return std::nullopt;
    return ghost.relative_flux * footprint->irradiance_at(point_px, kSmallestReach_px);
  }
  if (!is_in_ellipse(ghost, point_px)) return std::nullopt;
  const Vec2 reach = reach_of(ghost);
  return ghost.relative_flux / (std::numbers::pi * reach.x * reach.y);
}

}  // namespace

std::vector<std::size_t> ghosts_under(const std::vector<GhostFigures>& figures, Vec2 point_px,
                                      std::span<const GhostFootprint> footprints) {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t k = 0; k < figures.size(); ++k) {
    if (!(figures[k].relative_flux > 0)) continue;
    const GhostFootprint* const footprint = k < footprints.size() ? &footprints[k] : nullptr;
    if (const auto there = irradiance(figures[k], footprint, point_px)) found.emplace_back(*there, k);
  }
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::size_t> under;
  for (const auto& ghost : found) under.push_back(ghost.second);
  return under;
}

}  // namespace contrejour::studio
