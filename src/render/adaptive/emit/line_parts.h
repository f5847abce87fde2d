// SPDX-License-Identifier: Apache-2.0
// The parts of a line in single pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::adaptive {

inline constexpr double kLeastPart = 1e-9;  // of a line: shorter parts are rounding errors

// Along one axis: the part of a line that lies between 0 and a size, and where the line enters the next pixel, as
// fractions of the line.
struct LineAxis {
  double first = 0.0, last = 1.0;
  double next = 0.0, step = 0.0;  // of pixels, from `first` on

  LineAxis(double from, double by, double size) {
    if (by == 0.0) {
      if (!(from >= 0.0 && from < size)) last = -1.0;
    } else {
      first = std::max(0.0, std::min(-from / by, (size - from) / by));
      last = std::min(1.0, std::max(-from / by, (size - from) / by));
    }
  }
  void begin(double from, double by, double at) {
    step = by == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / std::abs(by);
    const double place = from + at * by;
    next = by == 0.0 ? step : at + (by > 0.0 ? std::floor(place) + 1.0 - place : place - std::ceil(place) + 1.0) * step;
  }
};

// Calls visit(Vec2 middle, double fraction) for the parts of a line that lie in single pixels of a frame.
template <class Visit>
void for_each_pixel_part(Vec2 from, Vec2 to, int width, int height, const Visit& visit) {
  const Vec2 by = to - from;
  LineAxis x(from.x, by.x, width), y(from.y, by.y, height);
  double at = std::max(x.first, y.first);
  const double last = std::min(x.last, y.last);
  if (!(at <= last)) return;
  if (by == Vec2{}) return visit(from, 1.0);
  x.begin(from.x, by.x, at);
  y.begin(from.y, by.y, at);
  // A line crosses no more pixels than this. Without the bound, one that is far longer than the frame would never end,
  // since a pixel is then less of it than rounding resolves.
  for (int left = width + height + 2; left > 0 && at < last; --left) {
    LineAxis& nearer = x.next < y.next ? x : y;
    const double end = std::min(nearer.next, last);
    if (end - at > kLeastPart) visit(from + by * (0.5 * (at + end)), end - at);
    nearer.next += nearer.step;
    at = std::max(at, end);
  }
}

}  // namespace contrejour::inline internal::adaptive
