// What may block a ray, as functions that are <= 0 where it passes: r_rel - 1, and the iris at each crossing.
#pragma once

#include <cstddef>
#include <vector>

#include "contrejour/iris.h"

namespace contrejour {

// The iris opening as straight edges, normal . p <= apothem; none for a full circle of radius 1.
// Near and inside the opening the distance to the farthest of them is iris_distance().
class IrisShape {
 public:
  explicit IrisShape(const Iris& iris);

  struct Edge {
    Vec2 normal;  // unit, outwards
  };
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  [[nodiscard]] double apothem() const { return apothem_; }
  [[nodiscard]] bool is_circle() const { return edges_.empty(); }

  // Signed distances of many points of the stop plane, in stop radii.
  void distances(const float* x, const float* y, std::size_t count, float* out) const;

 private:
  std::vector<Edge> edges_;
  double apothem_ = 1.0;
};

}  // namespace contrejour
