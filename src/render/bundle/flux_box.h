// SPDX-License-Identifier: Apache-2.0
// Flux over a rectangle of pixels; the exact part of a convex polygon that falls on each pixel.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::bundle {

// Pixels x in [x0, x1), y in [y0, y1) of the frame.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
  [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
};

// Flux per pixel area: at a point, and its change with x and y.
struct Density {
  Vec2 point;
  double value = 0.0;
  Vec2 gradient{};
};

// The part of a polygon's row with constant coverage: the columns between the last that a left edge touches and the
// first that a right edge touches.
struct RowSpan {
  int left_end = -1;
  int right_begin = std::numeric_limits<int>::max();
};

class FluxBox {
 public:
  explicit FluxBox(const PixelBox& box);

  [[nodiscard]] const PixelBox& box() const { return box_; }
  [[nodiscard]] std::span<const float> row(int y) const {
    return {flux_.data() + index(box_.x0, y), static_cast<std::size_t>(box_.width())};
  }

  // Adds a convex polygon of either orientation. Each pixel receives the area of the polygon inside it times the
  // density there; light outside the box is lost.
  void add_polygon(std::span<const Vec2> polygon, const Density& density);

  // Adds a convex polygon whose transmittance is evaluated at the middle of each pixel.
  using PixelTransmittance = std::function<double(Vec2 middle)>;
  void add_polygon(std::span<const Vec2> polygon, const Density& density, const PixelTransmittance& transmittance);

  // Adds all the flux to the pixel of the point, or along a line in proportion to length: for polygons without area.
  void add_point(Vec2 point, double flux);
  void add_line(Vec2 from, Vec2 to, double flux);

  // The same flux in pixels `factor` times as large; the frame's corner stays at a corner.
  [[nodiscard]] FluxBox coarser(int factor) const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - box_.y0) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(x - box_.x0);
  }
  void add_clipped(std::span<const Vec2> polygon, const Density& density, const PixelTransmittance* transmittance);
  void add_inside(std::span<const Vec2> polygon, const Density& density, const PixelTransmittance* transmittance);
  void add_halves(std::span<const Vec2> polygon, const Density& density, const PixelTransmittance* transmittance,
                  bool cut_columns, double at);

  PixelBox box_;
  std::vector<float> flux_;
  std::vector<float> cover_;     // signed coverage of the present polygon, as differences along each row
  std::vector<RowSpan> span_;    // where the coverage of each of its rows is constant
};

}  // namespace contrejour::inline internal::bundle
