// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/clip/bound_view.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::adaptive {

BoundView::BoundView(const IrisBound& bound, std::span<const PlacedCorner> polygon)
    : normal_(bound.normal), outer_(bound.apothem), radius_(bound.radius) {
  if (bound.straight()) return;
  Vec2 middle{};
  for (const PlacedCorner& c : polygon) middle = middle + c.stop * (1.0 / static_cast<double>(polygon.size()));
  const Vec2 from = middle - bound.centre;
  const double far = length(from);
  normal_ = far > 0.0 ? from * (1.0 / far) : Vec2{1.0, 0.0};
  for (const PlacedCorner& c : polygon)
    sideways_ = std::max(sideways_, std::abs(cross(normal_, c.stop - bound.centre)));
  outer_ = dot(normal_, bound.centre) + radius_;
}

// For an arc the strip spans a rectangle about the arc's centre that is as wide as the polygon and whose corners lie
// `depth` within the arc.
Strip BoundView::deeper_than(double depth) const {
  if (std::isinf(radius_)) return {.distance = outer_ - depth};
  const double radius = radius_ - depth, centre = outer_ - radius_;
  if (radius <= sideways_) return {centre, centre};
  const double chord = std::sqrt(radius * radius - sideways_ * sideways_);
  return {centre - chord, centre + chord};
}

}  // namespace contrejour::inline internal::adaptive
