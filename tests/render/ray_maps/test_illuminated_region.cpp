// SPDX-License-Identifier: Apache-2.0
// The part of a pupil box that must be drawn.
#include <cmath>
#include <functional>
#include <limits>

#include <doctest/doctest.h>

#include "render/ray_maps/illuminated_region.h"
#include "render/ray_maps/lobatto.h"

using namespace contrejour;
using namespace contrejour::ray_maps;

namespace {

constexpr int kNodes = 9;
constexpr float kFails = std::numeric_limits<float>::infinity();

// The rays of a pupil of 2 x 2 mm about the axis, on a sensor of 2 x 2 mm (200 x 200 pixels).
LobattoRays rays_of(const std::function<Vec2(Vec2)>& sensor_mm, const std::function<float(Vec2)>& relative_height) {
  LobattoRays ray_set;
  ray_set.nodes = kNodes;
  ray_set.box = {{-1.0, -1.0}, {1.0, 1.0}};
  const auto points = lobatto_points(kNodes);
  for (const double y : points) {
    for (const double x : points) {
      const Vec2 at = sensor_mm({x, y});
      ray_set.sensor_x_mm.push_back(static_cast<float>(at.x));
      ray_set.sensor_y_mm.push_back(static_cast<float>(at.y));
      ray_set.relative_height.push_back(relative_height({x, y}));
    }
  }
  return ray_set;
}

std::optional<Rectangle> part_of(const LobattoRays& ray_set, bool with_mirror_image = false) {
  const Frame frame{200, 200, 0, 0, 200, 200, 0.01};
  return illuminated_region({&ray_set, 1}, LightFrame(LightSource({0.0, 0.0, 1.0})), frame, with_mirror_image);
}

float open(Vec2 /*p*/) { return 0.5F; }

}  // namespace

TEST_CASE("all of a box whose light is in the frame is illuminated, and of one next to a rim what is within") {
  const auto even = [](Vec2 p) { return p * 0.5; };
  const auto all = part_of(rays_of(even, open));
  REQUIRE(all.has_value());
  CHECK(all->low == Vec2{-1.0, -1.0});
  CHECK(all->high == Vec2{1.0, 1.0});
  const auto half = part_of(rays_of(even, [](Vec2 p) { return static_cast<float>(1.0 - 4.0 * p.x); }));
  REQUIRE(half.has_value());
  CHECK(half->low.x > -0.75);
  CHECK(half->low.x <= 0.0);
  CHECK(half->high == Vec2{1.0, 1.0});
}

TEST_CASE("light that lands outside the frame is not drawn, but where its mirror image is") {
  const auto far = [](Vec2 p) { return Vec2{p.x * 8.0, p.y * 0.5}; };
  const auto part = part_of(rays_of(far, open));
  REQUIRE(part.has_value());
  CHECK(part->low.x < -0.125);
  CHECK(part->high.x > 0.125);
  CHECK(part->high.x - part->low.x < 1.6);
  const auto above = [](Vec2 p) { return Vec2{p.x * 0.5, 4.0 + p.y}; };
  CHECK_FALSE(part_of(rays_of(above, open)).has_value());
  // Parts of a picture of 200 x 1000 pixels, whose middle is on the axis.
  const Frame upper{200, 200, 0, 100, 200, 1000, 0.01}, lower{200, 200, 0, 700, 200, 1000, 0.01};
  const LobattoRays ray_set = rays_of([](Vec2 p) { return Vec2{p.x * 0.5, 3.0 + p.y * 0.2}; }, open);
  const LightFrame light(LightSource({0.0, 0.0, 1.0}));
  const bool lands_in_upper = illuminated_region({&ray_set, 1}, light, upper, false).has_value();
  CHECK(lands_in_upper != illuminated_region({&ray_set, 1}, light, lower, false).has_value());
  CHECK(illuminated_region({&ray_set, 1}, light, upper, true).has_value());
  CHECK(illuminated_region({&ray_set, 1}, light, lower, true).has_value());
}

TEST_CASE("next to rays that fail light is searched as far as it may land") {
  // Rays fail beyond x = 0.5; before that their image points move far out, with the square root of the remaining
  // distance.
  const auto flung = [](Vec2 p) { return Vec2{3.0 * std::sqrt(std::max(0.5 - p.x, 0.0)) - 0.9, 0.0}; };
  const auto part = part_of(rays_of(flung, [](Vec2 p) { return p.x < 0.5 ? 0.5F : kFails; }));
  REQUIRE(part.has_value());
  CHECK(part->high.x >= 0.5);
}
