// SPDX-License-Identifier: Apache-2.0
// Linear bounds over a polygon: what they call deep within a bound must be so all over the polygon.
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "render/adaptive/clip/bound_view.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

std::vector<PlacedCorner> rectangle(Vec2 middle, Vec2 half_across, Vec2 half_up) {
  std::vector<PlacedCorner> corners;
  for (const auto [s, t] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
    corners.push_back({{}, {}, middle + half_across * s + half_up * t});
  return corners;
}

IrisBound circle(Vec2 centre, double radius) {
  IrisBound bound;
  bound.centre = centre;
  bound.radius = radius;
  return bound;
}

}  // namespace

TEST_CASE("what a polygon has between two lines is as deep within a bound as asked, small polygons and large") {
  std::mt19937 random(3);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  int deep = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    IrisBound bound = circle(Vec2{any(random), any(random)} * 0.5, 1.2 + any(random));
    if (trial % 4 == 0) {
      const double angle = 3.0 * any(random);
      bound = {};
      bound.normal = {std::cos(angle), std::sin(angle)};
      bound.apothem = any(random);
    }
    const double rotation = 3.0 * any(random), size = std::exp2(2.0 * any(random));
    const Vec2 along{std::cos(rotation), std::sin(rotation)}, middle = Vec2{any(random), any(random)} * 1.5;
    const Vec2 across = along * (size * (0.6 + 0.5 * any(random)));
    const Vec2 up = Vec2{-along.y, along.x} * (size * (0.6 + 0.5 * any(random)));
    const BoundView view(bound, rectangle(middle, across, up));
    const double depth = 0.3 * (1.0 + any(random));
    const Strip band = view.deeper_than(depth);
    for (int k = 0; k < 100; ++k) {
      const Vec2 p = middle + across * any(random) + up * any(random);
      const double position = dot(view.normal(), p);
      if (bound.distance(p) <= 0.0) CHECK(position <= view.outer() + 1e-12);
      if (band.is_empty() || position <= band.near_distance || position >= band.distance) continue;
      ++deep;
      CHECK(bound.distance(p) <= -depth + 1e-12);
    }
  }
  CHECK(deep > 5000);
}

TEST_CASE("lines lie close to a bound that a polygon sees little of, and nowhere in one that it holds all of") {
  const IrisBound unit = circle({}, 1.0);
  const Strip narrow = BoundView(unit, rectangle({0.9, 0.0}, {0.2, 0.0}, {0.0, 0.1})).deeper_than(0.05);
  CHECK(narrow.distance == test::approx(std::sqrt(0.95 * 0.95 - 0.01)));
  CHECK(narrow.near_distance == test::approx(-narrow.distance));
  CHECK(BoundView(unit, rectangle({0.1, 0.0}, {1.3, 0.0}, {0.0, 1.2})).deeper_than(0.1).is_empty());
  CHECK(BoundView(unit, rectangle({}, {0.2, 0.0}, {0.0, 0.2})).deeper_than(2.0).is_empty());
  IrisBound straight;
  straight.normal = {0.0, 1.0};
  straight.apothem = 0.5;
  const Strip half_plane = BoundView(straight, rectangle({}, {2.0, 0.0}, {0.0, 2.0})).deeper_than(0.1);
  CHECK(half_plane.distance == test::approx(0.4));
  CHECK(std::isinf(half_plane.near_distance));
}
