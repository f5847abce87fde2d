// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/band_stop_pattern.h"

#include <algorithm>

namespace contrejour::inline internal::stop_patterns {

bool BandStopPattern::is_monochrome() const {
  return parts.size() == 1 && parts.front().channel == std::array{1.0F, 1.0F, 1.0F};
}

void BandStopPattern::add(const Part& part, const EdgeProfile::Range& range, const BoundingPolygon& visible) {
  parts.push_back(part);
  bounding_polygon.include(visible);
  const EdgePattern* const edge = part.pattern->edges();
  edges = edge == nullptr || (parts.size() > 1 && edges == nullptr) ? nullptr : parts.front().pattern->edges();
  if (edge == nullptr) return;
  fringe_unit = std::min(fringe_unit, edge->fringe_unit());
  dark_beyond = std::max(dark_beyond, -range.dark * edge->fringe_unit());
  level_within = std::max(level_within, range.level * edge->fringe_unit());
}

std::vector<const PatternTexture*> BandStopPattern::textures() const {
  std::vector<const PatternTexture*> all;
  for (const Part& part : parts) {
    if (part.pattern->texture() == nullptr) return {};
    all.push_back(part.pattern->texture());
  }
  return all;
}

std::array<double, 3> BandStopPattern::transmittance(std::span<const StopPoint> points) const {
  std::array<double, 3> sum{};
  for (const Part& part : parts) {
    const double transmitted = part.pattern->transmittance(points);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += part.channel[c] * transmitted;
  }
  return sum;
}

// An upper bound of a pattern near `middle`: the largest sample there, but no more than the largest as far from the
// centre.
double BandStopPattern::brightest(Vec2 middle, double radius) const {
  double beyond = 0.0;
  for (const Part& part : parts)
    beyond = std::max(beyond, part.pattern->texture()->brightest_beyond(length(middle) - radius));
  return std::min(beyond, static_cast<double>(texture->brightest(middle, radius)));
}

PatternView BandStopPattern::over(Vec2 middle, double radius) const {
  constexpr double kUniform = 1e-3;  // a pattern of the whole iris counts as uniform within this tolerance
  if (edges != nullptr) {
    const double distance = edges->distance(middle);
    const double outside = distance - radius;  // farther out it is darker
    if (outside > dark_beyond) return {PatternRegion::Dark, 0.0};
    return {distance + radius < -level_within ? PatternRegion::Uniform : PatternRegion::Varying,
            outside > 0.0 ? edges->edge(outside, 0.0) : 1.0};
  }
  if (texture && bounding_polygon.excludes(middle, radius)) return {PatternRegion::Dark, 0.0};
  const double max_transmittance = texture ? std::min(brightest(middle, radius), 1.0) : 1.0;
  const PatternRegion first = parts.front().pattern->region(middle, radius, kUniform);
  for (std::size_t k = 1; k < parts.size() && first != PatternRegion::Varying; ++k)
    if (parts[k].pattern->region(middle, radius, kUniform) != first) return {PatternRegion::Varying, max_transmittance};
  return {first, max_transmittance};
}

}  // namespace contrejour::inline internal::stop_patterns
