// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <doctest/doctest.h>

#include "render/area_lights/light_pieces.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

Light with_shape(Image level, Vec2 centre_px, double pixel) {
  Light light;
  light.shape =
      std::make_shared<const LightShape>(LightShape{std::move(level), centre_px, {pixel, 0.0}, {0.0, -pixel}});
  return light;
}

}  // namespace

TEST_CASE("a disc's pieces hold its value, and a small disc's covariance is a quarter of its squared radius") {
  for (const double radius : {0.001, kSunRadius_rad, 0.05, 0.3}) {
    Light light;
    light.direction = direction_from_angles(0.2, 0.1);
    light.value = {3.0, 2.0, 1.0};
    light.radius_rad = radius;
    Rgb sum{};
    Vec2 centre;
    const auto pieces = pieces_of(light);
    for (const LightPiece& piece : pieces) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += piece.point.value[c];
      centre = centre + piece.middle * (piece.point.value[0] / light.value[0]);
      double fraction = 0.0;
      for (const ShapeSample& s : piece.samples) fraction += s.fraction[1];
      CHECK(fraction == test::approx(1.0));
      CHECK(piece.point.is_point());
    }
    for (std::size_t c = 0; c < 3; ++c) CHECK(sum[c] == test::approx(light.value[c]));
    CHECK(length(centre) < 1e-6);
    if (pieces.size() > 1) continue;
    const double wanted = 0.25 * std::pow(std::tan(radius), 2);
    CHECK(pieces[0].covariance.x.x == test::approx(wanted).epsilon(0.01));
    CHECK(pieces[0].covariance.y.y == test::approx(wanted).epsilon(0.01));
  }
}

TEST_CASE("a shape's pieces lie where its light is, with the fraction of each channel") {
  Image level(3, 1);
  level.at(0, 0, 0) = 1.0F;  // red on the left, green on the right, no blue
  level.at(2, 0, 1) = 4.0F;
  Light light = with_shape(level, {1.5, 0.5}, 0.002);
  light.value = {10.0, 20.0, 5.0};
  const auto pieces = pieces_of(light);
  REQUIRE(pieces.size() == 1);
  for (std::size_t c = 0; c < 3; ++c) CHECK(pieces[0].point.value[c] == test::approx(light.value[c]));
  Vec2 red;
  for (const ShapeSample& s : pieces[0].samples) red = red + (s.at + pieces[0].middle) * s.fraction[0];
  CHECK(red.x == test::approx(-0.002));
  CHECK(red.y == test::approx(0.0));
}

TEST_CASE("extents that are none are refused with a reason") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double radius : {-0.001, 0.8, nan, std::numeric_limits<double>::infinity()}) {
    Light light;
    light.radius_rad = radius;
    CHECK_FALSE(check_extent(light).has_value());
  }
  Image dark(2, 2, 1), bright(2, 2, 1), negative(2, 2, 1), colours(2, 2, 2);
  bright.at(0, 0) = 1.0F;
  negative.at(0, 0) = -1.0F;
  colours.at(0, 0) = 1.0F;
  CHECK(check_extent(with_shape(bright, {1, 1}, 0.01)).has_value());
  CHECK_FALSE(check_extent(with_shape(dark, {1, 1}, 0.01)).has_value());
  CHECK_FALSE(check_extent(with_shape(negative, {1, 1}, 0.01)).has_value());
  CHECK_FALSE(check_extent(with_shape(colours, {1, 1}, 0.01)).has_value());
  CHECK_FALSE(check_extent(with_shape(bright, {1, 1}, 2.0)).has_value());
  CHECK_FALSE(check_extent(with_shape(bright, {nan, 1}, 0.01)).has_value());
  CHECK_FALSE(check_extent(with_shape({}, {1, 1}, 0.01)).has_value());
  Light both = with_shape(bright, {1, 1}, 0.01);
  both.radius_rad = 0.1;
  CHECK_FALSE(check_extent(both).has_value());
}

TEST_CASE("offset from a direction: right and up as the photographer sees them") {
  const Vec3 right = offset_direction({0, 0, 1}, {0.1, 0.0}), up = offset_direction({0, 0, 1}, {0.0, 0.1});
  CHECK(angles_from_direction(right).azimuth_rad == test::approx(std::atan(0.1)));
  CHECK(angles_from_direction(up).elevation_rad == test::approx(std::atan(0.1)));
  const Vec3 d = direction_from_angles(0.7, -0.5);
  CHECK(length(offset_direction(d, {}) - d) < 1e-12);
  CHECK(dot(offset_direction(d, {0.3, 0.4}), d) == test::approx(1.0 / std::sqrt(1.25)));
}
