// How a cell's pixels see the stop: the place where their light crosses it, to the second order of the pixel. Where a
// cell is thinner than a few pixels, to the first.
#pragma once

#include <array>
#include <span>

#include "contrejour/trace.h"
#include "contrejour/vec.h"
#include "render/interface/stop_screen.h"

namespace contrejour::adaptive {

// What a cell's vertices tell of a field, over coordinates that go from -1 to 1 both ways:
// middle + u x + v y + (uu x^2 + vv y^2) / 2 + uv x y.
struct CellSeries {
  Vec2 middle, u, v, uu, uv, vv;

  // corner, side: in turn, a side after the corner it starts from. The middle's and the sides' values, or none.
  [[nodiscard]] static CellSeries of(const std::array<Vec2, 4>& corner, const std::array<Vec2, 4>& side, Vec2 middle);
  [[nodiscard]] static CellSeries of_corners(const std::array<Vec2, 4>& c) {
    return {(c[0] + c[1] + c[2] + c[3]) * 0.25, (c[1] + c[2] - c[0] - c[3]) * 0.25,
            (c[2] + c[3] - c[0] - c[1]) * 0.25, {},
            (c[0] + c[2] - c[1] - c[3]) * 0.25, {}};
  }
  [[nodiscard]] static CellSeries of_triangle(const std::array<Vec2, 3>& corner);
};

class StopMap {
 public:
  // pixel: of the frame. stop: at each crossing, stop radii. A cell that is thinner than `softness_px` counts as so
  // thick, so that the map goes on tamely beyond it.
  StopMap(const CellSeries& pixel, std::span<const CellSeries> stop, double softness_px);

  // At the last crossing.
  [[nodiscard]] Vec2 place(Vec2 pixel) const { return place(pixel, crossings_ - 1); }
  [[nodiscard]] Vec2 place(Vec2 pixel, std::size_t crossing) const {
    const Vec2 q = pixel - origin_px_;
    const Crossing& t = crossing_[crossing];
    return t.level + t.x * q.x + t.y * q.y + t.xx * (q.x * q.x) + t.xy * (q.x * q.y) + t.yy * (q.y * q.y);
  }
  [[nodiscard]] double width() const { return crossing_[crossings_ - 1].width; }  // of a pixel there, stop radii
  // How far from its middle a pixel sees, at the most; to the first order, stop radii.
  [[nodiscard]] double pixel_reach() const {
    const Crossing& t = crossing_[crossings_ - 1];
    return 0.5 * (length(t.x) + length(t.y));
  }
  [[nodiscard]] double bend() const { return bend_; }  // how far from linear it is at the cell's corners, stop radii
  [[nodiscard]] int crossings() const { return static_cast<int>(crossings_); }

  // For every crossing.
  [[nodiscard]] std::span<const StopPlace> places(Vec2 pixel, std::array<StopPlace, kMaxStopCrossings>& room) const;

  // Of the last crossing, with q the pixel's place from origin(): level + x q.x + y q.y + xx q.x^2 + xy q.x q.y + yy
  // q.y^2.
  struct Form {
    float level = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };
  // weights . place + more.
  [[nodiscard]] Form form(Vec2 weights, double more) const {
    const Crossing& t = crossing_[crossings_ - 1];
    const auto of = [&](Vec2 term) { return static_cast<float>(dot(weights, term)); };
    return {static_cast<float>(dot(weights, t.level) + more), of(t.x), of(t.y), of(t.xx), of(t.xy), of(t.yy)};
  }
  [[nodiscard]] Vec2 origin() const { return origin_px_; }
  // The same for places whose pixels are parts of these, so many times as narrow.
  [[nodiscard]] StopMap narrowed(int times) const {
    StopMap out = *this;
    for (Crossing& crossing : out.crossing_) crossing.width /= times;
    return out;
  }

 private:
  struct Crossing {
    Vec2 level, x, y, xx, xy, yy;  // terms of a polynomial in pixels from the origin
    double width = 0.0;
  };

  Vec2 origin_px_;
  std::array<Crossing, kMaxStopCrossings> crossing_;
  std::size_t crossings_;
  double bend_ = 0.0;
};

}  // namespace contrejour::adaptive
