// SPDX-License-Identifier: Apache-2.0
// A cell as an interpolation between its corners: values between them, and where its rays cross the stop.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "render/adaptive/clip/corner.h"

namespace contrejour::inline internal::adaptive {

class IsoparametricCell {
 public:
  static constexpr std::size_t kCurvedCorners = 8;  // corners, where sides curve in their middles
  // Stop coordinates of a crossing: sum of terms times 1, u, v, u v, u^2, v^2, u^2 v, u v^2.
  using StopSeries = std::array<Vec2, 8>;

  IsoparametricCell() = default;
  // corners: at uv (0, 0), (1, 0), (1, 1), (0, 1); or the first three of them; or the four, each followed by the middle
  // of the next side. They must outlive this object. limits: the number of `limit` values in use.
  IsoparametricCell(std::span<const Corner> corners, std::size_t limits) : corners_(corners), limits_(limits) {}

  [[nodiscard]] bool is_curved() const { return corners_.size() == kCurvedCorners; }
  [[nodiscard]] std::size_t limits() const { return limits_; }
  [[nodiscard]] Corner at(Vec2 uv) const;
  // Appends the corners whose rays cross the stop at these points, which follow one another starting near near_uv.
  // Points at which the map curves too much for Newton's method are left out. limit: the index of the crossing's first
  // coordinate.
  void add_crossing(std::span<const Vec2> stop, std::size_t limit, Vec2 near_uv, std::vector<Corner>& to) const;

 private:
  std::span<const Corner> corners_;
  std::size_t limits_ = 0;
};

}  // namespace contrejour::inline internal::adaptive
