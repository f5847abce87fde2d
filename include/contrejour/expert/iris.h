// SPDX-License-Identifier: Apache-2.0
// The shape of the aperture stop's opening in the stop plane, in stop radii.
// Blades with curved edges close over a round hole of radius 1; where the blades lie outside the hole, its rim is the
// edge. Accuracy: iris_distance is exact inside and near the edges, IrisOpening::distance everywhere
// (docs/physics/diffraction.md). Thread-safety: plain values. Source: hullin2011 3.3 and figure 5, generalised.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"

namespace contrejour {

class IrisField;

struct Iris {
  int blades = 0;  // 0 to 2: a full circle; 3 and more: as many edges
  double rotation_rad = 0.0;  // first corner, counter-clockwise from +x as the photographer sees it
  double curvature = 0.0;  // of the edges, 0..1: 0 (below 1e-5) straight, 1 arcs of the circle through the corners
  double blade_radius = 1.0;  // of that circle. 1: the corners touch the rim; 1 / cos(pi / blades): the rim alone is
                              // the edge
  double asymmetry = 0.0;  // 0..0.5: each edge lies nearer or farther by up to this fraction of its distance
  std::uint32_t seed = 0;  // of the random asymmetry
  std::vector<double> blade_offset = {};  // further offsets, relative, edge by edge, > 0 outwards; missing ones are 0
  std::shared_ptr<const IrisField> field = nullptr;  // a picture (iris_field.h) in place of blades, turned as they are
  // 0..0.5: RMS deviation of a curved edge's slope from its arc's, divided by the angle by which the arc turns. Real
  // blades are not exact arcs, which blurs the ends of the fans in a starburst. Ghosts use the exact arcs.
  double slope_spread = 0.1;
  friend bool operator==(const Iris&, const Iris&) = default;
};

// Signed distance from the edge in stop radii, negative inside; beyond a corner a lower bound of the true one. point:
// position in the stop plane divided by the stop radius.
[[nodiscard]] CONTREJOUR_API double iris_distance(const Iris& iris, Vec2 point);

// Transmittance at a point, 0 to 1. Within an opening it is 1, except for a picture's half-tones (iris_field.h): then
// it is their mean over an upright square of the picture, `width` stop radii wide. A wave's amplitude is its square
// root.
[[nodiscard]] CONTREJOUR_API double iris_transmittance(const Iris& iris, Vec2 point, double width = 0.0);

// RMS of the edges' slopes about those of IrisOpening, in radians: 0 for straight edges, pictures and without blades.
[[nodiscard]] CONTREJOUR_API double iris_slope_spread_rad(const Iris& iris);

// Area of the opening, weighted by its transmittance, over the area of the rim's circle.
[[nodiscard]] CONTREJOUR_API double iris_area_fraction(const Iris& iris);

// A circle or half-plane that bounds the opening.
struct IrisBound {
  Vec2 normal;  // straight: unit, outwards
  double apothem = 0;  // straight: normal . p <= apothem
  Vec2 centre;  // curved: |p - centre| <= radius
  double radius = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool straight() const { return radius == std::numeric_limits<double>::infinity(); }
  [[nodiscard]] double distance(Vec2 p) const {
    const Vec2 from = p - centre;
    return straight() ? dot(normal, p) - apothem : std::sqrt(dot(from, from)) - radius;
  }
  // For a curved bound: |p - centre|^2 - radius^2 at p = 0.
  [[nodiscard]] double power_at_axis() const { return dot(centre, centre) - radius * radius; }
  friend bool operator==(const IrisBound&, const IrisBound&) = default;
};

// A piece of the outline, counter-clockwise from start to end; a full circle has start == end.
struct IrisEdge {
  IrisBound bound;
  Vec2 start, end;
};

// The opening with its outline, computed once for many points: the intersection of all bounds, which is convex.
class CONTREJOUR_API IrisOpening {
 public:
  // Uses blades and rim: a picture has no such outline. cut: further bounds that block everything outside them,
  // such as other apertures as imaged into the stop (vignetting).
  explicit IrisOpening(const Iris& iris, std::span<const IrisBound> cut = {});

  [[nodiscard]] double distance(Vec2 point) const;  // Euclidean, negative inside; infinite when nothing is open
  [[nodiscard]] double bound_distance(
      Vec2 point) const;  // faster; beyond a corner an underestimate, like iris_distance
  [[nodiscard]] double area() const;  // for a rim of radius 1: pi when wide open
  [[nodiscard]] double perimeter() const;
  [[nodiscard]] double outer_radius() const;  // distance of the farthest point from the axis
  [[nodiscard]] const std::vector<IrisEdge>& edges() const { return edges_; }
  [[nodiscard]] bool closed() const { return edges_.empty(); }

 private:
  std::vector<IrisEdge> edges_;
};

}  // namespace contrejour
