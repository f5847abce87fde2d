// SPDX-License-Identifier: Apache-2.0
// Pictures as irises: closed forms, counting, invalid pictures.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/scalar.h"
#include "support/approx.h"
#include "support/pictures.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

Vec2 scattered(int k) {  // spread over the square, R2 sequence
  const double x = k * 0.7548776662466927, y = k * 0.5698402909980532;
  return {2.2 * (x - std::floor(x)) - 1.1, 2.2 * (y - std::floor(y)) - 1.1};
}

std::shared_ptr<const IrisField> of_levels(const std::vector<float>& level, int width, int height) {
  const auto field = IrisField::from_levels(level, width, height);
  REQUIRE(field.has_value());
  return *field;
}

bool contains(const IrisPiece& piece, Vec2 p) {
  bool inside = p.x >= piece.low.x && p.x < piece.high.x && p.y >= piece.low.y && p.y < piece.high.y;
  for (int c = 0; c < piece.cuts; ++c) inside = inside && piece.cut[static_cast<std::size_t>(c)].distance(p) <= 0.0;
  return inside;
}

}  // namespace

TEST_CASE("a white picture of any size is the round stop") {
  for (const int side : {1, 2, 7, 64, 127, 500}) {
    CAPTURE(side);
    const auto field = of_levels(std::vector<float>(static_cast<std::size_t>(side * side), 0.3F), side, side);
    CHECK(field->area() / kPi == test::approx(1.0).epsilon(2e-4));
    for (int k = 0; k < 200; ++k) {
      const Vec2 p = scattered(k);
      if (length(p) > 0.9 && length(p) < 1.0)
        CHECK(field->distance(p) == test::approx(length(p) - 1.0).epsilon(1e-4).scale(1.0));
      CHECK((field->distance(p) <= 0.0) == (length(p) <= 1.0));
    }
  }
}

TEST_CASE("right side up, and the longer side across the stop") {
  SUBCASE("the upper right quarter") {
    const auto field = drawn_field(200, [](Vec2 p) { return p.x > 0.0 && p.y > 0.0; });
    CHECK(field->distance({0.4, 0.3}) == test::approx(-0.3).epsilon(0.01));
    for (const Vec2 p : {Vec2{-0.3, 0.4}, Vec2{0.3, -0.4}, Vec2{-0.3, -0.4}}) CHECK(field->distance(p) > 0.25);
    CHECK(field->area() == test::approx(kPi / 4.0).epsilon(0.01));
  }
  SUBCASE("a wide picture leaves a band") {
    const auto field = of_levels(std::vector<float>(4, 1.0F), 4, 1);
    const double expected = 2.0 * (0.25 * std::sqrt(1.0 - 0.0625) + std::asin(0.25));
    CHECK(field->area() == test::approx(expected).epsilon(2e-3));
    CHECK(field->distance({0.0, 0.1}) == test::approx(-0.15).epsilon(1e-3));
    CHECK(field->distance({0.1, 0.5}) == test::approx(0.25).epsilon(1e-3));
  }
}

TEST_CASE("near edges distances are those of the shape drawn, its area that of counting") {
  const auto disc = drawn_field(300, [](Vec2 p) { return length(p - Vec2{0.2, -0.1}) < 0.5; });
  for (int k = 0; k < 500; ++k) {
    const Vec2 p = scattered(k);
    const double expected = std::max(length(p - Vec2{0.2, -0.1}) - 0.5, length(p) - 1.0);
    if (std::abs(expected) > 0.1 || length(p) > 1.0) continue;
    CHECK(std::abs(disc->distance(p) - expected) < 0.2 * 2.0 / disc->samples() + 1e-6);
  }
  CHECK(disc->area() / (kPi * 0.25) == test::approx(1.0).epsilon(1e-3));
  int inside = 0;
  for (int k = 0; k < 400000; ++k) inside += is_in_flower(scattered(k)) ? 1 : 0;
  CHECK(flower_field()->area() / (2.2 * 2.2 * inside / 400000) == test::approx(1.0).epsilon(3e-3));
}

TEST_CASE("the distance never changes faster than one walks") {
  const auto field = flower_field();
  for (int k = 0; k < 5000; ++k) {
    const Vec2 p = scattered(k), q = scattered(k + 1);
    CHECK(std::abs(field->distance(p) - field->distance(q)) <= length(p - q) + 0.5 * 2.0 / field->samples());
  }
}

TEST_CASE("pieces are the opening, once") {
  const auto field = flower_field();
  for (int k = 0; k < 4000; ++k) {
    const Vec2 p = scattered(k);
    int pieces = 0;
    field->for_each_piece(p, p, 0.0, [&](const IrisPiece& piece) { pieces += contains(piece, p) ? 1 : 0; });
    CHECK(pieces <= 1);
    if (std::abs(field->distance(p)) > 2.0 * IrisField::kTolerance) CHECK(pieces == (field->distance(p) < 0.0 ? 1 : 0));
  }
}

TEST_CASE("without details the same light passes") {
  const auto field = flower_field();
  for (const double detail : {0.01, 0.05, 0.3, 3.0}) {
    double error = 0.0, light = 0.0;
    constexpr int kPoints = 40000;
    for (int k = 0; k < kPoints; ++k) {
      const Vec2 p = scattered(k);
      double here = 0.0;
      field->for_each_piece(p, p, detail,
                            [&](const IrisPiece& piece) { here += contains(piece, p) ? piece.open : 0.0; });
      light += here * 2.2 * 2.2 / kPoints;
      // Only values near edges may differ.
      if (std::abs(field->distance(p)) > 1.5 * detail + 1e-3)
        error = std::max(error, std::abs(here - (field->distance(p) < 0.0 ? 1.0 : 0.0)));
    }
    CHECK(error == 0.0);
    CHECK(light / field->area() == test::approx(1.0).epsilon(0.01));
  }
}

TEST_CASE("the hull holds all that is open, and little more") {
  const auto field = drawn_field(200, [](Vec2 p) { return length(p - Vec2{0.3, 0.2}) < 0.4; });
  for (const IrisBound& bound : field->hull()) {
    const double support = dot(bound.normal, Vec2{0.3, 0.2}) + 0.4;
    CHECK(bound.apothem >= support - 0.05 * 2.0 / field->samples());
    CHECK(bound.apothem <= support + 2e-3);
  }
}

TEST_CASE("an iris of a picture turns with it") {
  Iris iris;
  iris.field = flower_field();
  const double drawn = iris_distance(iris, {0.3, 0.1});
  iris.rotation_rad = 0.5 * kPi;
  CHECK(iris_distance(iris, {-0.1, 0.3}) == test::approx(drawn));
  CHECK(iris_area_fraction(iris) == test::approx(iris.field->area() / kPi));
}

TEST_CASE("smooth edges are no half-tones: such a picture lets all of the light pass or none") {
  for (const auto& field : {flower_field(), flower_field(64), drawn_field(300, [](Vec2 p) { return p.x > 0.1 * p.y; }),
                            drawn_field(30, [](Vec2 p) { return length(p - Vec2{0.2, 0.1}) < 0.6; })}) {
    CHECK_FALSE(field->has_half_tones());
    for (int k = 0; k < 500; ++k) {
      const Vec2 p = scattered(k);
      CHECK(field->transmittance(p) == (field->distance(p) <= 0.0 ? 1.0 : 0.0));
      CHECK(field->transmittance(p, 0.1) == field->transmittance(p));
    }
  }
}

TEST_CASE("half-tones let their share of the light pass") {
  const auto tone = [](Vec2 p) { return 0.5 + 0.4 * p.x - 0.1 * p.y * p.y; };
  const auto in_ring = [](Vec2 p) { return length(p) > 0.2 && length(p - Vec2{0.3, 0.0}) > 0.1; };
  for (const int side : {100, 301, 1500}) {
    CAPTURE(side);
    const auto field = drawn_field(side, [&](Vec2 p) { return in_ring(p) ? tone(p) : 0.0; });
    REQUIRE(field->has_half_tones());
    const double highest = tone({1.0 - 1.0 / side, 0.0}), pixel = 2.0 / std::min(side, field->samples());
    double light = 0.0, area = 0.0;
    for (int k = 0; k < 40000; ++k) {
      const Vec2 p = scattered(k);
      const double from_edge = std::min(std::abs(length(p) - 0.2), std::abs(length(p - Vec2{0.3, 0.0}) - 0.1));
      if (length(p) > 1.0) {
        CHECK(field->distance(p) > 0.0);
        continue;
      }
      area += 1.0;
      light += in_ring(p) ? tone(p) / highest : 0.0;
      if (from_edge < 2.0 * pixel || length(p) > 1.0 - pixel) continue;
      CHECK((field->distance(p) <= 0.0) == in_ring(p));
      CHECK(field->transmittance(p) == test::approx(in_ring(p) ? tone(p) / highest : 0.0).epsilon(2e-3));
      if (in_ring(p) && from_edge > 0.1 && length(p) < 0.9)  // quadratic: the square's mean by hand
        CHECK(field->transmittance(p, 0.12) == test::approx((tone(p) - 0.1 * 0.0144 / 12.0) / highest).epsilon(2e-3));
    }
    CHECK(field->area() == test::approx(light / area * kPi).epsilon(2e-3));
    Iris iris;
    iris.field = field;
    iris.rotation_rad = 0.5 * kPi;
    CHECK(iris_transmittance(iris, {0.1, 0.6}) == field->transmittance({0.6, -0.1}));
    CHECK(iris_transmittance(iris, {0.0, 0.1}) == 0.0);
    CHECK(iris_area_fraction(iris) == test::approx(field->area() / kPi));
  }
}

TEST_CASE("a grey line is a half-tone, an even grey is none") {
  const auto line = drawn_field(200, [](Vec2 p) { return std::abs(p.x - 0.005) < 0.005 ? 0.5 : 1.0; });
  REQUIRE(line->has_half_tones());
  CHECK(line->transmittance({0.005, 0.3}) == test::approx(0.5));
  CHECK(line->transmittance({0.1, 0.3}) == test::approx(1.0));
  CHECK_FALSE(drawn_field(50, [](Vec2) { return 0.4; })->has_half_tones());
  CHECK(iris_transmittance(Iris{6}, {0.1, 0.2}) == 1.0);
  CHECK(iris_transmittance(Iris{6}, {0.9, 0.9}) == 0.0);
}

TEST_CASE("pictures that are none are refused") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  struct Case {
    std::vector<float> level;
    int width, height;
  };
  for (const Case& c : {Case{{}, 0, 0}, Case{{1.0F}, 1, 2}, Case{{}, -1, -1}, Case{{0.0F, 0.0F}, 2, 1},
                        Case{{1.0F, kNan}, 2, 1}, Case{{kInf}, 1, 1}, Case{{1.0F, -0.5F}, 1, 2}})
    CHECK_FALSE(IrisField::from_levels(c.level, c.width, c.height).has_value());
  // Only corners beyond the rim are white.
  std::vector<float> corners(400, 0.0F);
  for (const std::size_t k : {0U, 19U, 380U, 399U}) corners[k] = 1.0F;
  CHECK_FALSE(IrisField::from_levels(corners, 20, 20).has_value());
  // One pixel of thousands.
  std::vector<float> speck(4096U * 4096U, 0.0F);
  speck[2048U * 4096U + 2048U] = 1.0F;
  CHECK_FALSE(IrisField::from_levels(speck, 4096, 4096).has_value());
}

TEST_CASE("a picture of noise is cut into pieces all the same") {
  std::vector<float> noise;
  std::uint32_t state = 1;
  for (int k = 0; k < 200 * 200; ++k) {
    state = state * 1664525U + 1013904223U;
    noise.push_back(static_cast<float>(state >> 8U) * 0x1p-24F);
  }
  const auto field = of_levels(noise, 200, 200);
  CHECK(field->area() > 1.0);
  CHECK(field->area() < 2.2);
  for (int k = 0; k < 2000; ++k) {
    const Vec2 p = scattered(k);
    int pieces = 0;
    field->for_each_piece(p, p, 0.0, [&](const IrisPiece& piece) { pieces += contains(piece, p) ? 1 : 0; });
    CHECK(pieces <= 1);
    if (std::abs(field->distance(p)) > 1e-3) CHECK(pieces == (field->distance(p) < 0.0 ? 1 : 0));
  }
}
