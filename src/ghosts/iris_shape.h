// What may block a ray at the iris, as functions that are <= 0 where it passes.
#pragma once

#include <cstddef>
#include <vector>

#include "contrejour/iris.h"

namespace contrejour {

// The iris opening as the circles and half-planes that its outline lies on: the rim where it shows, then the blades in
// their order. What all of them leave is the opening, which is convex; the distance to the farthest of them is
// iris_distance() inside and near the opening.
class IrisShape {
 public:
  explicit IrisShape(const Iris& iris);

  [[nodiscard]] const std::vector<IrisBound>& bounds() const { return bounds_; }
  [[nodiscard]] bool is_circle() const { return is_circle_; }  // of radius 1 about the axis

  // Signed distances of many points of the stop plane, in stop radii.
  void distances(const float* x, const float* y, std::size_t count, float* out) const;

 private:
  std::vector<IrisBound> bounds_;  // never empty
  bool is_circle_ = false;
};

}  // namespace contrejour
