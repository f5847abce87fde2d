// Flux over a rectangle of pixels, and the exact share of a convex polygon that each of them gets.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "contrejour/vec.h"

namespace contrejour::bundle {

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

// The level part of a row of a polygon: the columns between the last that a left edge touches and the first that
// a right edge does.
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

  // Convex, either orientation. Each pixel gets the part of the polygon inside it times the density there; what
  // lies outside the box is lost.
  void add_polygon(std::span<const Vec2> polygon, const Density& density);

  // The same, each pixel's part times a share that is asked for at its middle.
  using PixelShare = std::function<double(Vec2 middle)>;
  void add_polygon(std::span<const Vec2> polygon, const Density& density, const PixelShare& share);

  // All the flux in the pixel of the point, or along a line by length: polygons without area.
  void add_point(Vec2 point, double flux);
  void add_line(Vec2 from, Vec2 to, double flux);

  // The same flux in pixels `factor` times as large; the frame's corner stays a corner.
  [[nodiscard]] FluxBox coarser(int factor) const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - box_.y0) * static_cast<std::size_t>(box_.width()) +
           static_cast<std::size_t>(x - box_.x0);
  }
  void add_clipped(std::span<const Vec2> polygon, const Density& density, const PixelShare* share);
  void add_inside(std::span<const Vec2> polygon, const Density& density, const PixelShare* share);
  void add_halves(std::span<const Vec2> polygon, const Density& density, const PixelShare* share, bool cut_columns,
                  double at);

  PixelBox box_;
  std::vector<float> flux_;
  std::vector<float> cover_;     // signed coverage of the polygon at hand, as differences along each row
  std::vector<RowSpan> span_;    // where each of its rows is level
};

}  // namespace contrejour::bundle
