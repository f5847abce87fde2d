#include "ghosts/iris_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour {

IrisShape::IrisShape(const Iris& iris) {
  if (iris.blades < 3) return;
  const double sector = 2.0 * std::numbers::pi / iris.blades;
  apothem_ = std::cos(0.5 * sector);
  for (int k = 0; k < iris.blades; ++k) {
    const double angle = iris.rotation_rad + (k + 0.5) * sector;
    edges_.push_back({{std::cos(angle), std::sin(angle)}});
  }
}

void IrisShape::distances(const float* x, const float* y, std::size_t count, float* out) const {
  if (is_circle()) {
    for (std::size_t k = 0; k < count; ++k) out[k] = std::sqrt(x[k] * x[k] + y[k] * y[k]) - 1.0F;
    return;
  }
  const auto apothem = static_cast<float>(apothem_);
  std::fill_n(out, count, -apothem);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto nx = static_cast<float>(edges_[e].normal.x);
    const auto ny = static_cast<float>(edges_[e].normal.y);
    for (std::size_t k = 0; k < count; ++k) {
      const float d = nx * x[k] + ny * y[k] - apothem;
      out[k] = e == 0 || d > out[k] ? d : out[k];
    }
  }
}

}  // namespace contrejour
