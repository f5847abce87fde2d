// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/stop_transmittance.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

constexpr double kDiscOfCell = 1.5;  // over the corners' distance from the middle: cells may be curved

// The disc of the stop, or of the dirt's plane, that contains a cell. point_of: a ray's point there.
struct Disc {
  Vec2 middle;
  double radius = 0.0;

  template <class PointOf>
  Disc(const StopTransmittance::Cell& cell, const PointOf& point_of) : middle(point_of(cell.middle)) {
    for (const StopCrossings& ray : cell.corners) radius = std::max(radius, length(point_of(ray) - middle));
    radius *= kDiscOfCell;
  }
};

// The sampled point of one crossing, and the side of the square about it. point_of: a ray's point there.
template <class PointOf>
StopPoint point_at(const StopTransmittance::Sample& at, const PointOf& point_of) {
  const Vec2 origin = point_of(at.corner[0]), u = point_of(at.corner[1]) - origin, v = point_of(at.corner[2]) - origin;
  return {origin + u * at.fractions.x + v * at.fractions.y, std::sqrt(0.5 * std::abs(cross(u, v)) / at.parts)};
}

}  // namespace

PatternRegion StopTransmittance::region(const Cell& cell, double tolerance) const {
  if (!pattern || cell.crossings == 0) return PatternRegion::Uniform;
  const std::size_t last = cell.crossings - 1;
  const Disc disc(cell, [&](const StopCrossings& ray) { return ray.stop[last]; });
  const PatternRegion region = pattern->region(disc.middle, disc.radius, tolerance);
  return region == PatternRegion::Uniform && last > 0 ? PatternRegion::Varying : region;  // earlier ones are sharp
}

bool StopTransmittance::is_clean(const Cell& cell) const {
  for (std::size_t c = 0; dirt && c < dirt_crossings(cell.crossings); ++c) {
    const Disc disc(cell, [&](const StopCrossings& ray) { return dirt_point_mm(ray, c); });
    if (!dirt->is_clean(disc.middle, disc.radius, c)) return false;
  }
  return true;
}

double StopTransmittance::pattern_transmittance(const Sample& at) const {
  std::array<StopPoint, kMaxStopCrossings> points;
  for (std::size_t c = 0; c < at.crossings; ++c)
    points[c] = point_at(at, [&](const StopCrossings& ray) { return ray.stop[c]; });
  return pattern->transmittance({points.data(), at.crossings});
}

double StopTransmittance::dirt_transmittance(const Sample& at) const {
  double all = 1.0;
  for (std::size_t c = 0; c < dirt_crossings(at.crossings); ++c) {
    const StopPoint point = point_at(at, [&](const StopCrossings& ray) { return dirt_point_mm(ray, c); });
    all *= dirt->transmission({point.at, point.width}, c);
  }
  return all;
}

}  // namespace contrejour::inline internal
