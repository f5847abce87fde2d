// SPDX-License-Identifier: Apache-2.0
// The open part of a triangle of rays: what the rims and the iris let pass of it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "ghosts/ray_grid.h"

namespace contrejour::inline internal::bundle {

using Triangle = std::array<std::size_t, 3>;  // vertices of a RayGrid

// Clips in the triangle's own coordinates (u, v): vertex 0 + u (vertex 1 - vertex 0) + v (vertex 2 - vertex 0).
// relative_height and the stop coordinates are interpolated linearly (hullin2011 4.1), so every rim and every straight
// edge of the iris cuts along a straight line; arcs are cut by tangents, whose number depends on the arc's angle within
// the triangle.
class TriangleClipper {
 public:
  explicit TriangleClipper(const IrisShape& iris) : iris_(iris) {}

  // A convex polygon of the open part, and its transmittance.
  using OpenPart = std::function<void(std::span<const Vec2> uv, double open)>;

  // Visits one part, or none when nothing is open; with a picture as the iris more parts, which do not overlap, with
  // details down to `finest`, a fraction of the triangle.
  void for_each_open_part(const RayGrid& grid, const Triangle& triangle, double finest, const OpenPart& visit);

 private:
  void start(const RayGrid& grid, const Triangle& triangle);
  void clip_by_pieces(const RayGrid& grid, const Triangle& triangle, double finest, int crossing, double open,
                      const OpenPart& visit);
  void cut(double at_0, double at_1, double at_2);
  void clip_by_iris(const RayGrid& grid, const Triangle& triangle, std::size_t crossing);
  void clip_by_bound(const std::array<Vec2, 3>& stop, const IrisBound& bound);
  void clip_by_circle(const std::array<Vec2, 3>& stop, Vec2 centre, double radius);
  void clip_by_edge(const std::array<Vec2, 3>& stop, Vec2 normal, double reach);

  const IrisShape& iris_;
  std::vector<Vec2> polygon_, next_;
};

// The area of a polygon in (u, v) over that of the triangle.
[[nodiscard]] double fraction_of_triangle(std::span<const Vec2> uv);

}  // namespace contrejour::inline internal::bundle
