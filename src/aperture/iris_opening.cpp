// SPDX-License-Identifier: Apache-2.0
// The outline of an iris: corners where two bounds cross inside all others, connected by pieces of bounds.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "aperture/iris_blades.h"
#include "contrejour/expert/iris.h"

namespace contrejour::inline internal {
namespace {

constexpr double kOnBound = 1e-9;     // stop radii: a corner lies on its bounds up to rounding
constexpr double kSameCorner = 1e-7;  // stop radii: corners of three bounds through one point are one corner
constexpr double kSameBound = 1e-12;  // stop radii, curvature: bounds that nowhere differ by more are one

void add_unless_known(std::vector<IrisBound>& bounds, const IrisBound& bound) {
  if (std::none_of(bounds.begin(), bounds.end(), [&](const IrisBound& known) { return same_bound(known, bound); }))
    bounds.push_back(bound);
}

// On a line, at distances -h and h from its foot; nothing where h^2 < 0.
std::vector<Vec2> pair_about(Vec2 foot, Vec2 along, double h2) {
  if (h2 < 0.0) return {};
  const double h = std::sqrt(h2);
  return {foot + along * h, foot - along * h};
}

std::vector<Vec2> crossings(const IrisBound& a, const IrisBound& b) {
  if (a.straight() && b.straight()) {
    const double det = cross(a.normal, b.normal);
    if (std::abs(det) < kSameBound) return {};
    return {{(a.apothem * b.normal.y - b.apothem * a.normal.y) / det,
             (b.apothem * a.normal.x - a.apothem * b.normal.x) / det}};
  }
  if (a.straight()) return crossings(b, a);
  if (b.straight()) {
    const double d = b.apothem - dot(b.normal, a.centre);
    return pair_about(a.centre + b.normal * d, {-b.normal.y, b.normal.x}, a.radius * a.radius - d * d);
  }
  if (a.radius > b.radius) return crossings(b, a);  // from the nearer centre, or the farther one's distance would round
  const Vec2 between = b.centre - a.centre;
  const double gap = length(between);
  if (gap < kSameBound) return {};
  const Vec2 u = between * (1.0 / gap);
  const double d = 0.5 * (gap + (a.radius - b.radius) * (a.radius + b.radius) / gap);
  return pair_about(a.centre + u * d, {-u.y, u.x}, a.radius * a.radius - d * d);
}

double worst_distance(const std::vector<IrisBound>& bounds, Vec2 p) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const IrisBound& bound : bounds) worst = std::max(worst, bound.distance(p));
  return worst;
}

// worst_distance() < kOnBound, with an exit at the first bound that fails: most crossings lie outside many bounds.
bool is_within(const std::vector<IrisBound>& bounds, Vec2 p) {
  return std::all_of(bounds.begin(), bounds.end(),
                     [&](const IrisBound& bound) { return bound.distance(p) < kOnBound; });
}

// Corners of the opening, counter-clockwise.
std::vector<Vec2> corners_of(const std::vector<IrisBound>& bounds) {
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (std::size_t j = i + 1; j < bounds.size(); ++j) {
      for (const Vec2 p : crossings(bounds[i], bounds[j])) {
        if (!is_within(bounds, p)) continue;
        const bool known =
            std::any_of(corners.begin(), corners.end(), [&](Vec2 c) { return length(c - p) < kSameCorner; });
        if (!known) corners.push_back(p);
      }
    }
  }
  Vec2 middle;
  for (const Vec2 c : corners) middle = middle + c * (1.0 / static_cast<double>(corners.size()));
  std::sort(corners.begin(), corners.end(), [&](Vec2 a, Vec2 b) {
    return std::atan2(a.y - middle.y, a.x - middle.x) < std::atan2(b.y - middle.y, b.x - middle.x);
  });
  return corners;
}

double angle_from(Vec2 centre, Vec2 p) { return std::atan2(p.y - centre.y, p.x - centre.x); }

// Counter-clockwise from start to end, in (0, 2 pi].
double arc_angle(const IrisEdge& edge) {
  const double angle = angle_from(edge.bound.centre, edge.end) - angle_from(edge.bound.centre, edge.start);
  return angle > 0.0 ? angle : angle + 2.0 * std::numbers::pi;
}

Vec2 middle_of(const IrisEdge& edge) {
  if (edge.bound.straight()) return (edge.start + edge.end) * 0.5;
  const double angle = angle_from(edge.bound.centre, edge.start) + 0.5 * arc_angle(edge);
  return edge.bound.centre + Vec2{std::cos(angle), std::sin(angle)} * edge.bound.radius;
}

// The bound that connects one corner to the next: both lie on it, and its middle is inside all others.
std::optional<IrisEdge> edge_between(const std::vector<IrisBound>& bounds, Vec2 start, Vec2 end) {
  std::optional<IrisEdge> best;
  double smallest = 1e-3;  // far above rounding, far below the distance of a wrong bound outside the others
  for (const IrisBound& bound : bounds) {
    if (std::abs(bound.distance(start)) > kSameCorner || std::abs(bound.distance(end)) > kSameCorner) continue;
    const IrisEdge edge{bound, start, end};
    const double outside = worst_distance(bounds, middle_of(edge));
    if (outside >= smallest) continue;
    smallest = outside;
    best = edge;
  }
  return best;
}

std::vector<IrisEdge> outline_of(const std::vector<IrisBound>& bounds) {
  const std::vector<Vec2> corners = corners_of(bounds);
  std::vector<IrisEdge> edges;
  if (corners.size() < 2) {  // one circle inside all others, or nothing
    for (const IrisBound& bound : bounds) {
      if (bound.straight()) continue;
      const Vec2 start = bound.centre + Vec2{bound.radius, 0.0};
      const std::array<Vec2, 3> probes{start, bound.centre + Vec2{-0.5, 0.8660254037844386} * bound.radius,
                                       bound.centre + Vec2{-0.5, -0.8660254037844386} * bound.radius};
      const bool inside = std::all_of(probes.begin(), probes.end(), [&](Vec2 p) { return is_within(bounds, p); });
      if (inside) return {{bound, start, start}};
    }
    return edges;
  }
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (const auto edge = edge_between(bounds, corners[k], corners[(k + 1) % corners.size()])) edges.push_back(*edge);
  return edges;
}

// Distance to a piece of the outline.
double distance_to(const IrisEdge& edge, Vec2 p) {
  if (edge.bound.straight()) {
    const Vec2 along = edge.end - edge.start;
    const double t = std::clamp(dot(p - edge.start, along) / dot(along, along), 0.0, 1.0);
    return length(p - edge.start - along * t);
  }
  const double span = arc_angle(edge);
  double angle = angle_from(edge.bound.centre, p) - angle_from(edge.bound.centre, edge.start);
  if (angle < 0.0) angle += 2.0 * std::numbers::pi;
  if (angle <= span) return std::abs(edge.bound.distance(p));
  return std::min(length(p - edge.start), length(p - edge.end));
}

}  // namespace

bool same_bound(const IrisBound& a, const IrisBound& b) {
  if (a.straight() != b.straight()) return false;
  if (a.straight()) return length(a.normal - b.normal) + std::abs(a.apothem - b.apothem) < kSameBound;
  return length(a.centre - b.centre) + std::abs(a.radius - b.radius) < kSameBound;
}

std::vector<IrisBound> iris_bounds(const Iris& iris) {
  std::vector<IrisBound> bounds{kIrisRim};
  const double sector = 2.0 * std::numbers::pi / std::max(iris.blades, 1);
  for (int k = 0; k < blade_count(iris); ++k)
    add_unless_known(bounds, edge_bound(iris, iris.rotation_rad + (k + 0.5) * sector, edge_offset(iris, k)));
  return bounds;
}

}  // namespace contrejour::inline internal

namespace contrejour {

IrisOpening::IrisOpening(const Iris& iris, std::span<const IrisBound> cut) {
  std::vector<IrisBound> bounds = iris_bounds(iris);
  for (const IrisBound& bound : cut) add_unless_known(bounds, bound);
  edges_ = outline_of(bounds);
}

double IrisOpening::bound_distance(Vec2 point) const {
  if (closed()) return std::numeric_limits<double>::infinity();
  double worst = -std::numeric_limits<double>::infinity();
  for (const IrisEdge& edge : edges_) worst = std::max(worst, edge.bound.distance(point));
  return worst;
}

double IrisOpening::distance(Vec2 point) const {
  // Inside a convex shape the nearest edge is the nearest bound; outside it, some edge's bound excludes the point.
  const double bound = bound_distance(point);
  if (bound <= 0.0) return bound;
  double nearest = std::numeric_limits<double>::infinity();
  for (const IrisEdge& edge : edges_) nearest = std::min(nearest, distance_to(edge, point));
  return nearest;
}

double IrisOpening::perimeter() const {
  double sum = 0.0;
  for (const IrisEdge& edge : edges_)
    sum += edge.bound.straight() ? length(edge.end - edge.start) : edge.bound.radius * arc_angle(edge);
  return sum;
}

double IrisOpening::outer_radius() const {
  double farthest = 0.0;
  for (const IrisEdge& edge : edges_) {
    farthest = std::max({farthest, length(edge.start), length(edge.end)});
    if (edge.bound.straight()) continue;
    // A circle is farthest from the axis beyond its centre.
    const double outwards = std::atan2(edge.bound.centre.y, edge.bound.centre.x);
    double angle = outwards - angle_from(edge.bound.centre, edge.start);
    angle -= 2.0 * std::numbers::pi * std::floor(angle / (2.0 * std::numbers::pi));
    if (angle <= arc_angle(edge)) farthest = std::max(farthest, length(edge.bound.centre) + edge.bound.radius);
  }
  return farthest;
}

// Green's theorem: the polygon of the corners, and what each arc adds beyond its chord.
double IrisOpening::area() const {
  double twice = 0.0;
  for (const IrisEdge& edge : edges_) {
    twice += cross(edge.start, edge.end);
    if (edge.bound.straight()) continue;
    const double angle = arc_angle(edge);
    twice += edge.bound.radius * edge.bound.radius * (angle - std::sin(angle));
  }
  return 0.5 * twice;
}

}  // namespace contrejour
