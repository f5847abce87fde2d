// A bound of the iris as a polygon sees it: which straight lines across it part what is within from what is not.
// Units: stop radii. Thread-safety: a value.
#pragma once

#include <limits>
#include <span>

#include "contrejour/iris.h"
#include "render/adaptive/cells/placed_polygon.h"

namespace contrejour::adaptive {

// Where normal . p is between two values.
struct Strip {
  double least = -std::numeric_limits<double>::infinity(), most = 0.0;
  [[nodiscard]] bool is_empty() const { return !(least < most); }
};

class BoundView {
 public:
  BoundView(const IrisBound& bound, std::span<const PlacedCorner> polygon);

  // A straight bound's own; an arc's where it is nearest to the polygon's middle.
  [[nodiscard]] Vec2 normal() const { return normal_; }
  // Nothing within the bound has a larger normal . p.
  [[nodiscard]] double outer() const { return outer_; }
  // Every place of the polygon in this strip is within the bound, at least so far from it.
  [[nodiscard]] Strip deeper_than(double depth) const;

 private:
  Vec2 normal_;
  double outer_ = 0.0;
  double radius_;          // infinite: straight
  double sideways_ = 0.0;  // how far from the normal through the arc's centre the polygon goes, on either side
};

}  // namespace contrejour::adaptive
