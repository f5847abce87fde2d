// SPDX-License-Identifier: Apache-2.0
// Surfaces other than spheres, in closed form: conics, polynomials in the radius, toroids, biconics.
// Lengths are in mm from the vertex; sag is along the surface's own axis. Conventions: docs/physics/surfaces.md (those
// of Zemax' Even Asphere, Odd Asphere, Toroidal and Biconic, and of CODE V's ASP, CYL, YTO). Exact up to rounding.
// Thread-safety: plain values, pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"

namespace contrejour {

enum class ShapeKind : std::uint8_t {
  Revolution,  // conic and polynomial in the distance r from the axis
  Toroid,  // a profile in y (conic and polynomial in |y|), rotated about a line parallel to y; a cylinder if that line
           // is infinitely far
  Biconic,  // a conic in each of x and y
};

// The shape besides the curvature c, which every surface has: that of all meridians of a surface of revolution, or of
// the y-z section of a toroid or a biconic.
struct CONTREJOUR_API SurfaceShape {
  ShapeKind kind = ShapeKind::Revolution;
  double conic = 0.0;  // of the profile: < -1 hyperbola, -1 parabola, > -1 ellipse, 0 circle
  std::vector<double> powers = {};  // [p - 1]: the coefficient of r^p or |y|^p, mm^(1 - p); none in a biconic
  double curvature_x_per_mm = 0;  // of a toroid or a biconic in the x-z section
  double conic_x = 0.0;  // of a biconic
  double rotation_rad = 0.0;  // of a toroid or a biconic: angle of its own x axis from the lens's, towards y

  static constexpr int kHighestPower = 20;

  // True if the curvature alone determines the surface: a sphere or a plane.
  [[nodiscard]] bool is_sphere() const;
  [[nodiscard]] bool has_axial_symmetry() const { return kind == ShapeKind::Revolution; }
  friend bool operator==(const SurfaceShape&, const SurfaceShape&) = default;
};

struct SurfacePoint {
  double sag_mm = 0;
  Vec2 slope;  // d sag / dx, d sag / dy
};

// Sag and slope at a point (x, y); none where the surface does not exist: the square root's argument is negative there.
[[nodiscard]] CONTREJOUR_API std::optional<SurfacePoint> surface_at(double curvature_per_mm, const SurfaceShape& shape,
                                                                    Vec2 at_mm);

// The lowest and highest sag on a circle about the axis, from samples; none unless the surface exists at all of them.
struct SagRange {
  double low_mm = 0, high_mm = 0;
};
[[nodiscard]] CONTREJOUR_API std::optional<SagRange> sag_range(double curvature_per_mm, const SurfaceShape& shape,
                                                               double radius_mm);

// A plane through the axis, in which first-order optics is done.
enum class Section : std::uint8_t { Y, X };

// The curvature of a section at the vertex (Euler's theorem), with a polynomial's r^2 term. A cone's tip has none; it
// is treated as blunt.
[[nodiscard]] CONTREJOUR_API double vertex_curvature(double curvature_per_mm, const SurfaceShape& shape,
                                                     Section section);

}  // namespace contrejour
