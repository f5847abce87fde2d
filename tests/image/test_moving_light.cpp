// SPDX-License-Identifier: Apache-2.0
// A light that moves while the shutter is open: the place, the width and the speed of its streak.
#include "contrejour/expert/moving_light.h"
#include "support/approx.h"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace contrejour;

namespace {

const Light kLight{.direction = direction_from_angles(0.2, -0.1), .value = {3, 2, 1}};

// The direction at an offset, in tangents, from the light's.
Vec3 at(double x, double y) { return offset_direction(kLight.direction, {x, y}); }

struct Moments {
  Vec2 mean, mean_square;  // of the tangents, to the right and up, from the light's direction
};

Moments moments_of(const Light& light) {
  Moments moments;
  double sum = 0.0;
  const LightShape& shape = *light.shape;
  for (int y = 0; y < shape.level.height; ++y)
    for (int x = 0; x < shape.level.width; ++x) {
      const Vec2 from = Vec2{x + 0.5, y + 0.5} - shape.centre_px;
      const Vec2 tangents = shape.right * from.x + shape.down * from.y;
      const double weight = shape.level.at(x, y, 0);
      sum += weight;
      moments.mean = moments.mean + tangents * weight;
      moments.mean_square = moments.mean_square + Vec2{tangents.x * tangents.x, tangents.y * tangents.y} * weight;
    }
  return {moments.mean * (1.0 / sum), moments.mean_square * (1.0 / sum)};
}

}  // namespace

TEST_CASE("tangents between directions are the inverse of an offset") {
  for (const Vec3 from : {Vec3{0, 0, 1}, kLight.direction, direction_from_angles(-1.2, 0.9)})
    for (const Vec2 tangents : {Vec2{0, 0}, Vec2{0.3, -0.2}, Vec2{-1e-6, 0.9}}) {
      const Vec2 back = tangents_between(from, offset_direction(from, tangents));
      CHECK(back.x == test::approx(tangents.x).epsilon(1e-12).scale(1.0));
      CHECK(back.y == test::approx(tangents.y).epsilon(1e-12));
    }
}

TEST_CASE("a straight path is a line of even brightness, as long as the path") {
  for (const Vec2 end : {Vec2{0.02, 0.0}, Vec2{0.0, -0.01}, Vec2{-0.03, 0.02}}) {
    const Light moved = swept_light(kLight, std::vector{at(-end.x, -end.y), at(end.x, end.y)});
    REQUIRE(moved.shape);
    CHECK(check_extent(moved));
    CHECK(moved.value == kLight.value);
    CHECK(length(moved.direction - kLight.direction) < 1e-12);
    const Moments moments = moments_of(moved);
    CHECK(length(moments.mean) < 1e-4 * length(end));
    const double cell2 = std::pow(2.0 * length(end) / 128.0, 2.0);  // what the raster adds
    CHECK(std::abs(moments.mean_square.x - end.x * end.x / 3.0) < cell2);
    CHECK(std::abs(moments.mean_square.y - end.y * end.y / 3.0) < cell2);
  }
}

TEST_CASE("where a light is slow its streak is bright") {
  // Three quarters of the time over the first half of the way.
  const std::vector<Vec3> path{at(-0.01, 0), at(-0.02 / 3, 0), at(-0.01 / 3, 0), at(0, 0), at(0.01, 0)};
  const Light moved = swept_light(kLight, path);
  REQUIRE(moved.shape);
  const Vec2 in_time = tangents_between(kLight.direction, moved.direction);
  CHECK(in_time.x == test::approx(-0.01 / 3).epsilon(1e-9));
  // Its mean over time: three quarters at -0.005, a quarter at 0.005.
  CHECK(in_time.x + moments_of(moved).mean.x == test::approx(-0.0025).epsilon(0.01));
}

TEST_CASE("a disc is swept along the path") {
  Light disc = kLight;
  disc.radius_rad = 0.004;
  const Light moved = swept_light(disc, std::vector{at(-0.01, 0), at(0.01, 0)});
  REQUIRE(moved.shape);
  CHECK(moved.radius_rad == 0.0);
  CHECK(check_extent(moved));
  const Moments moments = moments_of(moved);
  const double disc_square = std::pow(std::tan(0.004), 2.0) / 4.0;
  CHECK(moments.mean_square.x == test::approx(1e-4 / 3.0 + disc_square).epsilon(0.01));
  CHECK(moments.mean_square.y == test::approx(disc_square).epsilon(0.03));
}

TEST_CASE("a curve lies where its segments do, and a path back is the path there") {
  const std::vector<Vec3> bend{at(-0.01, 0), at(0, 0), at(0, 0.01)};
  const Moments bent = moments_of(swept_light(kLight, bend));
  CHECK(bent.mean.x == test::approx(-0.0025).epsilon(0.01));
  CHECK(bent.mean.y == test::approx(0.0025).epsilon(0.01));
  const Light to_and_fro = swept_light(kLight, std::vector{at(0.01, 0), at(-0.01, 0), at(0.01, 0)});
  REQUIRE(to_and_fro.shape);
  CHECK(length(to_and_fro.direction - at(-0.01, 0)) < 1e-12);
  CHECK(moments_of(to_and_fro).mean.x == test::approx(0.01).epsilon(0.01));
}

TEST_CASE("a light that hardly moves stays as it is") {
  CHECK_FALSE(swept_light(kLight, std::vector{at(0, 0)}).shape);
  CHECK_FALSE(swept_light(kLight, std::vector{at(-1e-9, 0), at(1e-9, 0)}).shape);
  Light disc = kLight;
  disc.radius_rad = 0.01;
  const Light still = swept_light(disc, std::vector{at(-1e-7, 0), at(1e-7, 0)});
  CHECK_FALSE(still.shape);
  CHECK(still.radius_rad == 0.01);
}

TEST_CASE("paths that no light takes are refused by the renderers' checks") {
  const auto is_refused = [](const std::vector<Vec3>& path) {
    return !check_light(swept_light(kLight, path), ColourSpace::Rec709);
  };
  const Vec3 left = direction_from_angles(-1.55, 0), right = direction_from_angles(1.55, 0);
  CHECK(is_refused({left, right}));
  CHECK(is_refused({left, left, right}));  // nearly behind the middle of the path
  CHECK(is_refused({left, Vec3{0, 0, 1}, right}));
  const double nan = std::nan("");
  CHECK(is_refused({Vec3{0, 0, 1}, Vec3{0, 0, 1}, Vec3{nan, nan, nan}}));
  CHECK(is_refused({Vec3{nan, 0, 1}, Vec3{0, 0, 1}}));
}
