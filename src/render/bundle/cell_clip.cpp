// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/cell_clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace contrejour::inline internal::bundle {
namespace {

// Tangents of a circle of radius r >= 1 deviate from its arc by less than 3e-4 if their spacing is this over sqrt(r).
constexpr double kTangentStep_rad = 0.05;
constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

double fraction_of_triangle(std::span<const Vec2> uv) {
  double twice = 0.0;
  for (std::size_t k = 2; k < uv.size(); ++k) twice += cross(uv[k - 1] - uv[0], uv[k] - uv[0]);
  return std::abs(twice);  // the whole triangle's is 1/2
}

// Keeps the part where a function that is linear over the triangle is <= 0 (Sutherland-Hodgman).
void TriangleClipper::cut(double at_0, double at_1, double at_2) {
  if (at_0 <= 0.0 && at_1 <= 0.0 && at_2 <= 0.0) return;
  const auto value = [&](Vec2 p) { return at_0 + p.x * (at_1 - at_0) + p.y * (at_2 - at_0); };
  next_.clear();
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Vec2 a = polygon_[k];
    const Vec2 b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const double fa = value(a);
    const double fb = value(b);
    if (fa <= 0.0) next_.push_back(a);
    if ((fa <= 0.0) != (fb <= 0.0)) next_.push_back(a + (b - a) * (fa / (fa - fb)));
  }
  polygon_.swap(next_);
}

void TriangleClipper::clip_by_edge(const std::array<Vec2, 3>& stop, Vec2 normal, double half_extent) {
  cut(dot(normal, stop[0]) - half_extent, dot(normal, stop[1]) - half_extent, dot(normal, stop[2]) - half_extent);
}

void TriangleClipper::clip_by_circle(const std::array<Vec2, 3>& stop, Vec2 centre, double radius) {
  const Vec2 middle = (stop[0] + stop[1] + stop[2]) * (1.0 / 3.0) - centre;
  double half_extent = 0.0;
  for (const Vec2 p : stop) half_extent = std::max(half_extent, length(p - centre - middle));
  const double distance = length(middle);
  // As seen from the circle's centre, the triangle lies within this angle of its middle.
  const double half_angle = distance > 1.5 * half_extent ? std::asin(half_extent / distance) : std::numbers::pi;
  const double step_rad = kTangentStep_rad / std::sqrt(std::max(radius, 1.0));
  const int tangents = 1 + static_cast<int>(std::ceil(2.0 * half_angle / step_rad));
  const double middle_angle = std::atan2(middle.y, middle.x);
  for (int k = 0; k < tangents; ++k) {
    const double angle = middle_angle + half_angle * ((2 * k + 1.0) / tangents - 1.0);
    const Vec2 normal{std::cos(angle), std::sin(angle)};
    clip_by_edge(stop, normal, radius + dot(normal, centre));
  }
}

void TriangleClipper::clip_by_bound(const std::array<Vec2, 3>& stop, const IrisBound& bound) {
  if (bound.straight()) return clip_by_edge(stop, bound.normal, bound.apothem);
  const auto inside = [&](Vec2 p) { return bound.distance(p) <= 0.0; };
  if (!std::all_of(stop.begin(), stop.end(), inside)) clip_by_circle(stop, bound.centre, bound.radius);
}

void TriangleClipper::clip_by_iris(const RayGrid& grid, const Triangle& triangle, std::size_t crossing) {
  std::array<Vec2, 3> stop;
  bool all_inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    stop[k] = {grid.stop_x[crossing][triangle[k]], grid.stop_y[crossing][triangle[k]]};
    all_inside = all_inside && grid.iris_distance[crossing][triangle[k]] <= 0.0F;
  }
  if (all_inside) return;  // the opening is convex
  if (iris_.is_circle()) {
    clip_by_circle(stop, {}, 1.0);
  } else {
    for (const IrisBound& bound : iris_.bounds()) clip_by_bound(stop, bound);
  }
}

void TriangleClipper::start(const RayGrid& grid, const Triangle& t) {
  polygon_.assign({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}});
  cut(grid.relative_height[t[0]] - 1.0, grid.relative_height[t[1]] - 1.0, grid.relative_height[t[2]] - 1.0);
}

void TriangleClipper::clip_by_pieces(const RayGrid& grid, const Triangle& t, double finest, int crossing, double open,
                                     const OpenPart& visit) {
  if (polygon_.size() < 3) return;
  if (crossing == grid.stop_crossings()) return visit(polygon_, open);
  const auto c = static_cast<std::size_t>(crossing);
  std::array<Vec2, 3> stop;
  for (std::size_t k = 0; k < 3; ++k) stop[k] = {grid.stop_x[c][t[k]], grid.stop_y[c][t[k]]};
  const std::vector<Vec2> before = polygon_;
  Vec2 low{kFar, kFar};
  Vec2 high{-kFar, -kFar};
  for (const Vec2 q : before) {
    const Vec2 p = stop[0] + (stop[1] - stop[0]) * q.x + (stop[2] - stop[0]) * q.y;
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double detail =
      finest * std::max({length(stop[1] - stop[0]), length(stop[2] - stop[1]), length(stop[0] - stop[2])});
  iris_.for_each_piece(low, high, detail, [&](std::span<const IrisBound> half_planes, double fraction) {
    polygon_ = before;
    for (const IrisBound& bound : half_planes) clip_by_edge(stop, bound.normal, bound.apothem);
    clip_by_pieces(grid, t, finest, crossing + 1, open * fraction, visit);
  });
}

void TriangleClipper::for_each_open_part(const RayGrid& grid, const Triangle& t, double finest, const OpenPart& visit) {
  start(grid, t);
  if (iris_.is_picture()) return clip_by_pieces(grid, t, finest, 0, 1.0, visit);
  for (int c = 0; c < grid.stop_crossings(); ++c) clip_by_iris(grid, t, static_cast<std::size_t>(c));
  if (polygon_.size() >= 3) visit(polygon_, 1.0);
}

}  // namespace contrejour::inline internal::bundle
