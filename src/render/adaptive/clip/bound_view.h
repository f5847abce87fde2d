// SPDX-License-Identifier: Apache-2.0
// A bound of the iris relative to a polygon: which straight lines across the polygon separate what is within the bound
// from what is not.
// Units: stop radii. Thread-safety: a value.
#pragma once

#include <limits>
#include <span>

#include "contrejour/expert/iris.h"
#include "render/adaptive/clip/placed_polygon.h"

namespace contrejour::inline internal::adaptive {

// The strip of points p with normal . p between `near_distance` and `distance`.
struct Strip {
  double near_distance = -std::numeric_limits<double>::infinity(), distance = 0.0;
  [[nodiscard]] bool is_empty() const { return !(near_distance < distance); }
};

class BoundView {
 public:
  BoundView(const IrisBound& bound, std::span<const PlacedCorner> polygon);

  // The normal of a straight bound, or that of an arc where it is nearest to the polygon's middle.
  [[nodiscard]] Vec2 normal() const { return normal_; }
  // The largest normal . p of a point within the bound.
  [[nodiscard]] double outer() const { return outer_; }
  // The strip in which every point of the polygon lies within the bound, at least `depth` from it.
  [[nodiscard]] Strip deeper_than(double depth) const;

 private:
  Vec2 normal_;
  double outer_ = 0.0;
  double radius_;          // infinite for a straight bound
  double sideways_ = 0.0;  // largest distance of the polygon from the normal through the arc's centre
};

}  // namespace contrejour::inline internal::adaptive
