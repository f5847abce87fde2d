// SPDX-License-Identifier: Apache-2.0
// One ghost of a measured flare, for a light at one angle: its outline of four cubic Bezier segments, which a circle
// may cut, the distance of a point from it, and its shade as a function of that distance. Source: walch2018 3.2,
// figures 5 and 6. Differs: a side's control length is a fraction of the half axes it joins, so that an ellipse stays
// one; a pixel has the mean of the shade over its width, so that sharp borders do not alias; a second aperture of the
// lens may cut the outline, so that a segment or a lune is left. Units: x along the line from the optical centre to the
// light, y perpendicular to it, both as tangents of angles (pixels / focal length in pixels). The outline is symmetric
// about y = 0. Accuracy: nearest points are minima to 1e-12 of the outline's size. Where a circle cuts the outline, the
// distance is the larger of both: outside a corner, it is below the true one. Thread-safety: pure functions.
#pragma once

#include <array>

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"

namespace contrejour {

// The control length of an ellipse's quarter over its half axes: within 2.7e-4 of the ellipse.
inline constexpr double kEllipseRoundness = 0.5522847498307936;

struct GhostOutline {
  double centre = 0;  // x
  double left = 0, right = 0;  // distances from the centre to the ends on the axis, > 0
  double half_height = 0;  // > 0
  double round_left = kEllipseRoundness, round_right = kEllipseRoundness;  // 0.05 ... 1: a rhombus to a rectangle
  // Only what lies within this circle is inside. Its centre is on the axis, not relative to the outline's; radius 0: no
  // circle.
  double clip_centre = 0, clip_radius = 0;
};
inline constexpr std::size_t kOutlineParameters = 8;  // in the order of GhostOutline's members

// The point of an outline nearest to another.
struct OutlinePoint {
  double distance = 0;  // signed: above 0 outside
  Vec2 normal;  // outward, unit
  bool is_right = false;  // on the right side
  double t = 0;  // parameter of the cubic on that side, from left to right
  bool is_below = false;  // the other point lies below the axis
  bool is_on_clip = false;  // on the circle that cuts the outline: neither side nor parameter count
};
[[nodiscard]] CONTREJOUR_API OutlinePoint nearest_point(const GhostOutline& outline, Vec2 point);

// Derivatives of the distance with respect to the outline's parameters. The nearest point's own movement drops out,
// because the distance is stationary there (envelope theorem).
[[nodiscard]] CONTREJOUR_API std::array<double, kOutlineParameters> distance_gradient(const GhostOutline& outline,
                                                                                      const OutlinePoint& nearest);

// The shade: at a distance x outside the border, border * (1 - x / fade_out)^slope_out; at y inside,
// inside + (border - inside) * (1 - y / fade_in)^slope_in; beyond the fades 0 and inside.
struct GhostShade {
  double fade_in = 0, fade_out = 0;  // >= 0, as distances
  double slope_in = 1, slope_out = 1;  // > 0
};

// A pixel's value is border * border_weight + inside * inside_weight.
struct ShadeWeights {
  double border = 0, inside = 0;
};
// Means over pixels of this width, > 0, whose centres are at a distance from the border.
[[nodiscard]] CONTREJOUR_API ShadeWeights shade_weights(const GhostShade& shade, double distance, double pixel_width);

// Both weights, and their derivatives with respect to the distance, and to the shade's members in their order.
struct ShadeDerivatives {
  ShadeWeights weights;
  ShadeWeights by_distance;
  std::array<ShadeWeights, 4> by_shade;
};
[[nodiscard]] CONTREJOUR_API ShadeDerivatives shade_derivatives(const GhostShade& shade, double distance,
                                                                double pixel_width);

}  // namespace contrejour
