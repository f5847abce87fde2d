// SPDX-License-Identifier: Apache-2.0
// Computes the part of a triangle of light that lands in a rectangle of the sensor.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "contrejour/expert/vec.h"
#include "ghosts/ray_grid.h"

namespace contrejour::inline internal::pupils {

// The fraction of a triangle's area that lies inside a rectangle.
class TriangleWindow {
 public:
  explicit TriangleWindow(const Rectangle& window) : low_(window.low), high_(window.high) {}

  // True if all points lie inside; if all lie beyond the same side.
  [[nodiscard]] bool holds(std::span<const Vec2> points) const {
    return std::ranges::all_of(
        points, [&](Vec2 p) { return p.x >= low_.x && p.x <= high_.x && p.y >= low_.y && p.y <= high_.y; });
  }
  [[nodiscard]] bool misses(std::span<const Vec2> points) const {
    bool left = true, right = true, below = true, above = true;
    for (const Vec2 p : points) {
      left = left && p.x < low_.x;
      right = right && p.x > high_.x;
      below = below && p.y < low_.y;
      above = above && p.y > high_.y;
    }
    return left || right || below || above;
  }

  [[nodiscard]] double fraction_of(const std::array<Vec2, 3>& triangle) const {
    Vec2 low = triangle[0], high = triangle[0];
    for (const Vec2 p : triangle) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    if (high.x < low_.x || high.y < low_.y || low.x > high_.x || low.y > high_.y) return 0.0;
    const double whole = std::abs(cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
    const double extent = std::max(high.x - low.x, high.y - low.y);
    constexpr double kLine = 1e-6;
    if (whole <= kLine * extent * extent) return fraction_of_line(low, high);
    return std::min(1.0, twice_area_within(triangle) / whole);
  }

 private:
  // The fraction of a degenerate triangle, approximately a line between two corners of its bounds.
  [[nodiscard]] double fraction_of_line(Vec2 from, Vec2 to) const {
    constexpr int kSteps = 16;
    int inside = 0;
    for (int k = 0; k < kSteps; ++k) {
      const Vec2 p = from + (to - from) * ((k + 0.5) / kSteps);
      inside += p.x >= low_.x && p.x <= high_.x && p.y >= low_.y && p.y <= high_.y ? 1 : 0;
    }
    return static_cast<double>(inside) / kSteps;
  }

  // Sutherland and Hodgman's clipping, one side after the other.
  [[nodiscard]] double twice_area_within(const std::array<Vec2, 3>& triangle) const {
    std::array<Vec2, 8> polygon{triangle[0], triangle[1], triangle[2]}, next;
    std::size_t count = 3;
    const auto clip = [&](const auto& inside_by) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const Vec2 a = polygon[k], b = polygon[(k + 1) % count];
        const double from = inside_by(a), to = inside_by(b);
        if (from >= 0.0) next[kept++] = a;
        if ((from < 0.0) != (to < 0.0)) next[kept++] = a + (b - a) * (from / (from - to));
      }
      polygon = next;
      count = kept;
    };
    clip([&](Vec2 p) { return p.x - low_.x; });
    clip([&](Vec2 p) { return high_.x - p.x; });
    clip([&](Vec2 p) { return p.y - low_.y; });
    clip([&](Vec2 p) { return high_.y - p.y; });
    double twice = 0.0;
    for (std::size_t k = 0; k < count; ++k) twice += cross(polygon[k], polygon[(k + 1) % count]);
    return std::abs(twice);
  }

  Vec2 low_, high_;
};

}  // namespace contrejour::inline internal::pupils
