// The opening of the aperture stop as a shape in the stop plane, in stop radii.
// Blades of curved edges close over a round hole of radius 1; where they stand farther out, the hole's rim shows.
// Accuracy: iris_distance is exact inside and near the edges, IrisOpening::distance everywhere
// (docs/physics/diffraction.md). Thread-safety: plain values. Source: hullin2011 3.3 and figure 5, generalised.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/vec.h"

namespace contrejour {

class IrisField;

struct Iris {
  int blades = 0;             // 0 to 2: a full circle; 3 and more: as many edges
  double rotation_rad = 0.0;  // first corner, counter-clockwise from +x as the photographer sees it
  double curvature = 0.0;  // of the edges, 0..1: 0 (below 1e-5) straight, 1 arcs of the circle through the corners
  double blade_radius = 1.0;  // of that circle. 1: its corners touch the rim; 1 / cos(pi / blades): only the rim shows
  double asymmetry = 0.0;  // 0..0.5: each edge stands nearer or farther by up to this share of its distance
  std::uint32_t seed = 0;  // which of these irises
  std::vector<double> blade_offset = {};  // further shares, edge by edge, > 0 outwards; missing ones are 0
  std::shared_ptr<const IrisField> field = nullptr;  // a picture (iris_field.h) in place of blades, turned as they are
  // 0..0.5: RMS of the slopes of a curved edge about its arc's, over the angle by which the arc bends. No blade is
  // exact: the ends of the fans in a starburst are smeared by it. Ghosts are the exact arcs'.
  double slope_spread = 0.1;
  friend bool operator==(const Iris&, const Iris&) = default;
};

// Signed distance from the edge in units of the stop radius, negative inside; no more than the true one beyond a
// corner. point: position in the stop plane divided by the stop radius.
[[nodiscard]] double iris_distance(const Iris& iris, Vec2 point);

// The share of light that passes there, 0 to 1: within an opening 1 but for a picture's half-tones (iris_field.h), of
// which it is the mean over an upright square of the picture, `width` stop radii wide. A wave's amplitude is its root.
[[nodiscard]] double iris_transmittance(const Iris& iris, Vec2 point, double width = 0.0);

// RMS of the edges' slopes about those of IrisOpening, in radians: 0 for straight edges, pictures and without blades.
[[nodiscard]] double iris_slope_spread_rad(const Iris& iris);

// Area of the opening, weighted with its transmittance, over the area of the rim's circle.
[[nodiscard]] double iris_area_fraction(const Iris& iris);

// A circle or half-plane that bounds the opening.
struct IrisBound {
  Vec2 normal;  // unit, outwards; of a straight edge
  double apothem = 0;  // straight: normal . p <= apothem
  Vec2 centre;  // of a curved one: |p - centre| <= radius
  double radius = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool straight() const { return radius == std::numeric_limits<double>::infinity(); }
  [[nodiscard]] double distance(Vec2 p) const {
    const Vec2 from = p - centre;
    return straight() ? dot(normal, p) - apothem : std::sqrt(dot(from, from)) - radius;
  }
  // Of a curved one: |p - centre|^2 - radius^2 at p = 0.
  [[nodiscard]] double power_at_axis() const { return dot(centre, centre) - radius * radius; }
  friend bool operator==(const IrisBound&, const IrisBound&) = default;
};

// A piece of the outline, counter-clockwise from start to end; a full circle has start == end.
struct IrisEdge {
  IrisBound bound;
  Vec2 start, end;
};

// The opening with its outline worked out, for many points: what all the bounds leave, which is convex.
class IrisOpening {
 public:
  // Of blades and rim: a picture has no such outline. cut: more circles that block what is outside them, such as other
  // apertures seen from the stop (vignetting).
  explicit IrisOpening(const Iris& iris, std::span<const IrisBound> cut = {});

  [[nodiscard]] double distance(Vec2 point) const;  // Euclidean, negative inside; infinite when nothing is open
  [[nodiscard]] double bound_distance(Vec2 point) const;  // quicker: less than that beyond a corner, as iris_distance
  [[nodiscard]] double area() const;  // of a rim of radius 1: pi when wide open
  [[nodiscard]] double perimeter() const;
  [[nodiscard]] double reach() const;  // of the point farthest from the axis
  [[nodiscard]] const std::vector<IrisEdge>& edges() const { return edges_; }
  [[nodiscard]] bool closed() const { return edges_.empty(); }

 private:
  std::vector<IrisEdge> edges_;
};

}  // namespace contrejour
