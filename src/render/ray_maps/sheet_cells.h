// SPDX-License-Identifier: Apache-2.0
// The cells between four neighbouring rays of a sheet, each identified by its first ray.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "render/ray_maps/lobatto.h"
#include "render/ray_maps/ray_sheet.h"

namespace contrejour::inline internal::ray_maps {

class SheetCells {
 public:
  explicit SheetCells(const RaySheet& sheet)
      : sheet_(sheet), n_(static_cast<std::size_t>(sheet.nodes)), points_(lobatto_points(sheet.nodes)) {}

  // First rays are those below this number for which has() is true.
  [[nodiscard]] std::size_t end() const { return sheet_.count() - n_ - 1; }
  [[nodiscard]] bool has(std::size_t first) const { return first % n_ != n_ - 1; }

  // The cell's four rays, in order around it.
  [[nodiscard]] std::array<std::size_t, 4> corners(std::size_t first) const {
    return {first, first + 1, first + n_ + 1, first + n_};
  }
  [[nodiscard]] double entrance_mm2(std::size_t first) const {
    const auto step = [&](std::size_t k) { return 0.5 * (points_[k + 1] - points_[k]); };
    const Vec2 size = sheet_.box.high - sheet_.box.low;
    return size.x * step(first % n_) * size.y * step(first / n_);
  }
  // The area of the cell's image on the sensor, with straight sides.
  [[nodiscard]] double image_mm2(std::size_t first) const {
    const auto at = [&](std::size_t k) { return Vec2{sheet_.sensor_x_mm[k], sheet_.sensor_y_mm[k]}; };
    const auto c = corners(first);
    return 0.5 * std::abs(cross(at(c[2]) - at(c[0]), at(c[3]) - at(c[1])));
  }

 private:
  const RaySheet& sheet_;
  std::size_t n_;
  const std::vector<double>& points_;
};

}  // namespace contrejour::inline internal::ray_maps
