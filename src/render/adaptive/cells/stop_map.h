// SPDX-License-Identifier: Apache-2.0
// The map from a cell's pixels to the points at which their light crosses the stop: a polynomial of second order in the
// pixel, or of first order where a cell is thinner than a few pixels.
#pragma once

#include <array>
#include <span>

#include "contrejour/expert/trace.h"
#include "contrejour/expert/vec.h"
#include "render/polygons/polygon_list.h"
#include "render/stop_patterns/stop_pattern.h"

namespace contrejour::inline internal::adaptive {

// The series of a field over a cell, from its values at the cell's vertices. Coordinates x and y go from -1 to 1:
// middle + u x + v y + (uu x^2 + vv y^2) / 2 + uv x y.
struct CellSeries {
  Vec2 middle, u, v, uu, uv, vv;

  // corner, side: in order around the cell, each side after the corner at which it starts.
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
  // pixel: of the frame. stop: at each crossing, in stop radii. A cell thinner than `min_thickness_px` is treated as if
  // it were that thick, so that the map does not become steep outside it.
  StopMap(const CellSeries& pixel, std::span<const CellSeries> stop, double min_thickness_px);

  // At the last crossing.
  [[nodiscard]] Vec2 stop_point(Vec2 pixel) const { return stop_point(pixel, crossings_ - 1); }
  [[nodiscard]] Vec2 stop_point(Vec2 pixel, std::size_t crossing) const {
    const Vec2 q = pixel - origin_px_;
    const Crossing& t = crossing_[crossing];
    return t.level + t.x * q.x + t.y * q.y + t.xx * (q.x * q.x) + t.xy * (q.x * q.y) + t.yy * (q.y * q.y);
  }
  [[nodiscard]] double width() const { return crossing_[crossings_ - 1].width; }  // of a pixel there, stop radii
  // The largest distance from its middle that a pixel averages over; to first order, in stop radii.
  [[nodiscard]] double pixel_extent() const {
    const Crossing& t = crossing_[crossings_ - 1];
    return 0.5 * (length(t.x) + length(t.y));
  }
  [[nodiscard]] double nonlinearity() const {
    return nonlinearity_;
  }  // how far from linear it is at the cell's corners, stop radii
  [[nodiscard]] int crossings() const { return static_cast<int>(crossings_); }

  // The points at every crossing. buffer: memory for the result.
  [[nodiscard]] std::span<const StopPoint> stop_points(Vec2 pixel,
                                                       std::array<StopPoint, kMaxStopCrossings>& buffer) const;

  // The map of the last crossing, for parts of pixels that are `times` narrower than pixels.
  [[nodiscard]] PatternMap last(int times) const {
    const Crossing& t = crossing_[crossings_ - 1];
    return {origin_px_, t.level, t.x, t.y, t.xx, t.xy, t.yy, t.width / times};
  }
  // The same map for such parts.
  [[nodiscard]] StopMap narrowed(int times) const {
    StopMap out = *this;
    for (Crossing& crossing : out.crossing_) crossing.width /= times;
    return out;
  }

 private:
  struct Crossing {
    Vec2 level, x, y, xx, xy, yy;  // coefficients of a polynomial in pixels relative to the origin
    double width = 0.0;
  };

  Vec2 origin_px_;
  std::array<Crossing, kMaxStopCrossings> crossing_;
  std::size_t crossings_;
  double nonlinearity_ = 0.0;
};

}  // namespace contrejour::inline internal::adaptive
