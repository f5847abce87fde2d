// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/stop_pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal {
namespace {

// In stop radii: pixels that cross the rim have their middle beyond it.
constexpr double kSharpOuterRadius = 1.05;

// The fraction of a square, `width` wide, that is inside a straight edge `distance` from its middle.
double sharp_transmittance(double distance, double width) {
  if (!(width > 0.0)) return distance <= 0.0 ? 1.0 : 0.0;
  return std::clamp(0.5 - distance / width, 0.0, 1.0);
}

// The distance from the opening, negative inside; too small beyond a corner.
double distance_from(const IrisShape& iris, Vec2 p) {
  if (iris.is_picture()) return iris.picture_distance(p);
  double largest = -std::numeric_limits<double>::infinity();
  for (const IrisBound& bound : iris.bounds()) largest = std::max(largest, bound.distance(p));
  return largest;
}

// The half-tone of a picture as the iris; otherwise 1.
double tone(const IrisShape& iris, const StopPoint& point) {
  return iris.has_half_tones() ? iris.picture_transmittance(point.at, point.width) : 1.0;
}

}  // namespace

namespace stop_patterns {

EdgePattern::EdgePattern(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeProfile> profile,
                         double fresnel_number)
    : iris_(std::move(iris)), profile_(std::move(profile)), scale_(std::sqrt(2.0 * fresnel_number)) {}

double EdgePattern::transmittance(const StopPoint& point) const {
  if (iris_->is_picture()) return edge(iris_->picture_distance(point.at), point.width);
  double all = 1.0;
  for (const IrisBound& bound : iris_->bounds()) {
    if (!(all > 0.0)) break;
    all *= edge(bound.distance(point.at), point.width);
  }
  return std::max(all, 0.0);
}

double EdgePattern::distance(Vec2 p) const { return distance_from(*iris_, p); }

PatternRegion EdgePattern::region(Vec2 middle, double radius, double tolerance) const {
  const double from_edge = distance(middle);
  if (scale_ * (from_edge - radius) > -EdgeProfile::kDarkBelow) return PatternRegion::Dark;
  const bool uniform = scale_ * (-from_edge - radius) > profile_->level_above(tolerance);
  return uniform ? PatternRegion::Uniform : PatternRegion::Varying;
}

PatternRegion TexturePattern::region(Vec2 middle, double radius, double /*tolerance*/) const {
  return length(middle) - radius > outer_radius() ? PatternRegion::Dark : PatternRegion::Varying;
}

double TonedPattern::outer_radius() const { return edges_ ? edges_->outer_radius() : kSharpOuterRadius; }

double TonedPattern::transmittance(const StopPoint& point) const {
  const double from_edge = distance_from(*iris_, point.at);
  const double open = edges_ ? edges_->edge(from_edge, point.width) : sharp_transmittance(from_edge, point.width);
  return open > 0.0 ? open * tone(*iris_, point) : 0.0;
}

PatternRegion TonedPattern::region(Vec2 middle, double radius, double tolerance) const {
  const bool dark = edges_ ? edges_->region(middle, radius, tolerance) == PatternRegion::Dark
                           : distance_from(*iris_, middle) > radius;
  return dark ? PatternRegion::Dark : PatternRegion::Varying;
}

}  // namespace stop_patterns

double StopPattern::outer_radius() const {
  return std::visit([](const auto& kind) { return kind.outer_radius(); }, kind_);
}

double StopPattern::transmittance(std::span<const StopPoint> points) const {
  if (points.empty()) return 1.0;
  double all = std::visit([&](const auto& kind) { return kind.transmittance(points.back()); }, kind_);
  for (const StopPoint& earlier : points.first(points.size() - 1))
    if (all > 0.0) all *= sharp_transmittance(distance_from(*iris_, earlier.at), earlier.width) * tone(*iris_, earlier);
  return all;
}

PatternRegion StopPattern::region(Vec2 middle, double radius, double tolerance) const {
  return std::visit([&](const auto& kind) { return kind.region(middle, radius, tolerance); }, kind_);
}

}  // namespace contrejour::inline internal
