// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/frame_peak.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>

namespace contrejour::inline internal::area {
namespace {

constexpr int kPeakCells = 40;  // across the frame: cells in which overlapping ghosts are summed

// A ghost's mean level in a cell at some distance of its middle, over its own level; lengths in cells. It fades over a
// cell's width, so that the sums change steadily as the ghost moves.
double coverage(double distance, double radius) {
  return std::clamp(radius - distance + 0.5, 0.0, 1.0) * std::min(std::numbers::pi * radius * radius, 1.0);
}

// The value that this fraction of all values reaches, or a little less: by linear interpolation between neighbours in
// their order.
double reached_by(std::vector<double> values, double fraction) {
  const double at = std::max((1.0 - fraction) * static_cast<double>(values.size() - 1) - 1.0, 0.0);
  const auto below = static_cast<std::ptrdiff_t>(at);
  const auto nth = values.begin() + below;
  std::nth_element(values.begin(), nth, values.end());
  if (nth + 1 == values.end()) return *nth;
  return std::lerp(*nth, *std::min_element(nth + 1, values.end()), at - static_cast<double>(below));
}

// The area of a blurred ghost that lies in the frame: of one as large across the frame's nearest border as across its
// longer axis. It is not quite 0 elsewhere, so that ghosts count if there are no others.
double visible_px(const GhostBlur& ghost, const Frame& frame) {
  constexpr double kBeside = 1e-6;
  const double radius_px = std::hypot(ghost.size_px.y, ghost.blur_px.y) + 0.5;
  const double inside = std::clamp(0.5 + 0.5 * inside_px(frame, ghost.at_px) / radius_px, 0.0, 1.0);
  return ghost.area_px * std::max(inside * inside * (3.0 - 2.0 * inside), kBeside);
}

// The level of the brightest ghosts that together fill about this area of the frame: the mean from half of it to one
// and a half times as much, which changes steadily as ghosts become brighter or enter the frame.
double brightest_over(const std::vector<GhostBlur>& ghosts, const Frame& frame, double area_px) {
  std::vector<const GhostBlur*> by_level;
  for (const GhostBlur& ghost : ghosts)
    if (ghost.level > 0.0) by_level.push_back(&ghost);
  std::ranges::stable_sort(by_level, std::greater(), &GhostBlur::level);
  const double from_px = 0.5 * area_px, to_px = 1.5 * area_px;
  double filled_px = 0.0, light = 0.0, counted_px = 0.0;
  for (const GhostBlur* ghost : by_level) {
    const double end_px = filled_px + visible_px(*ghost, frame);
    const double within_px = std::max(std::min(end_px, to_px) - std::max(filled_px, from_px), 0.0);
    light += ghost->level * within_px;
    counted_px += within_px;
    filled_px = end_px;
  }
  if (counted_px > 0.0) return light / counted_px;
  return by_level.empty() ? 0.0 : by_level.back()->level;
}

}  // namespace

double peak_of(const std::vector<GhostBlur>& ghosts, const Frame& frame) {
  // Sums overlapping ghosts in the cells of a small frame.
  const double cell = static_cast<double>(std::max(frame.width, frame.height)) / kPeakCells;
  const int columns = std::max(1, static_cast<int>(frame.width / cell));
  const int rows = std::max(1, static_cast<int>(frame.height / cell));
  std::vector<double> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0);
  const auto within = [](double at, int count) { return static_cast<int>(std::clamp(at, 0.0, count - 1.0)); };
  for (const GhostBlur& ghost : ghosts) {
    if (!(ghost.level > 0.0)) continue;
    const Vec2 at = ghost.at_px * (1.0 / cell) - Vec2{0.5, 0.5};
    const double radius = std::sqrt(ghost.area_px / std::numbers::pi) / cell, reach = radius + 0.5;
    for (int y = within(at.y - reach, rows); y <= within(at.y + reach, rows); ++y)
      for (int x = within(at.x - reach, columns); x <= within(at.x + reach, columns); ++x)
        sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] +=
            ghost.level * coverage(length(Vec2{x - at.x, y - at.y}), radius);
  }
  // Spots are smaller than such a cell.
  return std::max(reached_by(std::move(sums), kPeakFraction),
                  brightest_over(ghosts, frame, kPeakFraction * frame.width * frame.height));
}

}  // namespace contrejour::inline internal::area
