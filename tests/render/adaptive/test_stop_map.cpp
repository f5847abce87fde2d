// SPDX-License-Identifier: Apache-2.0
// Maps from pixels to points in the stop, against maps whose inverse is known.
#include <cmath>

#include <doctest/doctest.h>

#include "render/adaptive/cells/stop_map.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

// A cell's vertices under a map of its coordinates.
template <class Map>
CellSeries series_of(const Map& map) {
  return CellSeries::of({map(Vec2{-1, -1}), map(Vec2{1, -1}), map(Vec2{1, 1}), map(Vec2{-1, 1})},
                        {map(Vec2{0, -1}), map(Vec2{1, 0}), map(Vec2{0, 1}), map(Vec2{-1, 0})}, map(Vec2{0, 0}));
}

// Pixels of a curved cell; the points in the stop are another polynomial of the cell's coordinates.
struct Curved {
  double sag = 0.0;
  [[nodiscard]] Vec2 pixel(Vec2 q) const {
    return Vec2{100.0, 50.0} + Vec2{20.0, 5.0} * q.x + Vec2{-4.0, 15.0} * q.y + Vec2{6.0, -3.0} * (sag * q.x * q.x) +
           Vec2{2.0, 4.0} * (sag * q.x * q.y) + Vec2{-3.0, 2.0} * (sag * q.y * q.y);
  }
  [[nodiscard]] static Vec2 stop(Vec2 q) {
    return Vec2{0.3, -0.2} + Vec2{0.1, 0.02} * q.x + Vec2{0.01, -0.2} * q.y + Vec2{0.02, 0.0} * (q.x * q.y);
  }
  [[nodiscard]] double worst() const {
    const StopMap map(series_of([&](Vec2 q) { return pixel(q); }), std::array{series_of(stop)}, 1e-6);
    double largest = 0.0;
    for (double x = -1.0; x <= 1.0; x += 0.1)
      for (double y = -1.0; y <= 1.0; y += 0.1)
        largest = std::max(largest, length(map.stop_point(pixel({x, y})) - stop({x, y})));
    return largest;
  }
};

}  // namespace

TEST_CASE("a series is a quadratic's own") {
  const auto quadratic = [](Vec2 q) {
    return Vec2{1, 2} + Vec2{3, -1} * q.x + Vec2{0.5, 4} * q.y + Vec2{0.25, 1} * (q.x * q.x) +
           Vec2{-2, 0.5} * (q.x * q.y) + Vec2{1, 1.5} * (q.y * q.y);
  };
  const CellSeries s = series_of(quadratic);
  CHECK(length(s.middle - Vec2{1, 2}) < 1e-12);
  CHECK(length(s.u - Vec2{3, -1}) < 1e-12);
  CHECK(length(s.v - Vec2{0.5, 4}) < 1e-12);
  CHECK(length(s.uu - Vec2{0.5, 2}) < 1e-12);
  CHECK(length(s.uv - Vec2{-2, 0.5}) < 1e-12);
  CHECK(length(s.vv - Vec2{2, 3}) < 1e-12);
}

TEST_CASE("what is off falls with the second power of the bend, and is nothing without") {
  CHECK(Curved{0.0}.worst() < 1e-6);
  const double large = Curved{0.2}.worst(), small = Curved{0.1}.worst();
  CHECK(large < 0.01);
  CHECK(small < 0.45 * large);  // the bend times itself and times the stop's own
}

TEST_CASE("forms are points, widths are areas, thin cells go on tamely") {
  const Curved curved{0.2};
  const CellSeries pixels = series_of([&](Vec2 q) { return curved.pixel(q); });
  const StopMap map(pixels, std::array{series_of(Curved::stop)}, 0.2);
  const Vec2 weights{3.0, -7.0};
  const PatternMap last = map.last(1);
  const PatternMap::Form form = last.form(weights, 0.25);
  for (const Vec2 pixel : {Vec2{90.5, 53.5}, Vec2{101.5, 40.5}, Vec2{118.5, 61.5}}) {
    const Vec2 q = pixel - last.origin_px;
    const double value =
        form.level + form.x * q.x + form.y * q.y + form.xx * q.x * q.x + form.xy * q.x * q.y + form.yy * q.y * q.y;
    CHECK(value == test::approx(dot(weights, map.stop_point(pixel)) + 0.25).epsilon(1e-5));
  }
  CHECK(last.width == test::approx(std::sqrt((0.1 * 0.2 + 0.01 * 0.02) / (20.0 * 15.0 + 5.0 * 4.0))).epsilon(1e-9));

  // A cell a hundredth of a pixel thick: one pixel outside it, the place is no farther than the cell's own points are
  // apart.
  const CellSeries thin{{10, 10}, {8, 0}, {0, 0.005}, {}, {}, {}};
  const StopMap tame(thin, std::array{CellSeries{{0, 0}, {0.2, 0}, {0, 0.3}, {}, {}, {}}}, 0.2);
  CHECK(std::abs(tame.stop_point({10, 11}).y) < 0.3);
  CHECK(tame.stop_point({14, 10}).x == test::approx(0.1).epsilon(0.01));
}
