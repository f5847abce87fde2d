// SPDX-License-Identifier: Apache-2.0
// The cells between four neighbouring rays of a ray set, each identified by its first ray.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "render/ray_maps/lobatto.h"
#include "render/ray_maps/lobatto_rays.h"

namespace contrejour::inline internal::ray_maps {

class LobattoCells {
 public:
  explicit LobattoCells(const LobattoRays& ray_set)
      : ray_set_(ray_set), n_(static_cast<std::size_t>(ray_set.nodes)), points_(lobatto_points(ray_set.nodes)) {}

  // First rays are those below this number for which has() is true.
  [[nodiscard]] std::size_t end() const { return ray_set_.count() - n_ - 1; }
  [[nodiscard]] bool has(std::size_t first) const { return first % n_ != n_ - 1; }

  // The cell's four rays, in order around it.
  [[nodiscard]] std::array<std::size_t, 4> corners(std::size_t first) const {
    return {first, first + 1, first + n_ + 1, first + n_};
  }
  [[nodiscard]] double entrance_mm2(std::size_t first) const {
    const auto step = [&](std::size_t k) { return 0.5 * (points_[k + 1] - points_[k]); };
    const Vec2 size = ray_set_.box.high - ray_set_.box.low;
    return size.x * step(first % n_) * size.y * step(first / n_);
  }
  // The area of the cell's image on the sensor, with straight sides.
  [[nodiscard]] double image_mm2(std::size_t first) const {
    const auto at = [&](std::size_t k) { return Vec2{ray_set_.sensor_x_mm[k], ray_set_.sensor_y_mm[k]}; };
    const auto c = corners(first);
    return 0.5 * std::abs(cross(at(c[2]) - at(c[0]), at(c[3]) - at(c[1])));
  }

 private:
  const LobattoRays& ray_set_;
  std::size_t n_;
  const std::vector<double>& points_;
};

}  // namespace contrejour::inline internal::ray_maps
