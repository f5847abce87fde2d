// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "render/adaptive/emit/line_parts.h"

using namespace contrejour;

namespace {

struct Part {
  Vec2 middle;
  double fraction = 0.0;
};

std::vector<Part> parts_of(Vec2 from, Vec2 to, int width, int height) {
  std::vector<Part> parts;
  adaptive::for_each_pixel_part(from, to, width, height,
                                [&](Vec2 middle, double fraction) { parts.push_back({middle, fraction}); });
  return parts;
}

double sum_of(const std::vector<Part>& parts) {
  double sum = 0.0;
  for (const Part& part : parts) sum += part.fraction;
  return sum;
}

}  // namespace

TEST_CASE("the parts of a line add to what lies in the frame, one in each pixel that it crosses") {
  constexpr int kWidth = 7, kHeight = 5;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-4.0, 11.0), y(-3.0, 8.0);
  int within = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec2 from{x(random), y(random)}, to{x(random), y(random)};
    const auto parts = parts_of(from, to, kWidth, kHeight);
    // The part in the frame by many points.
    constexpr int kPoints = 4000;
    int inside = 0;
    for (int j = 0; j < kPoints; ++j) {
      const Vec2 at = from + (to - from) * ((j + 0.5) / kPoints);
      inside += at.x >= 0.0 && at.y >= 0.0 && at.x < kWidth && at.y < kHeight ? 1 : 0;
    }
    within += inside > 0 ? 1 : 0;
    CHECK(std::abs(sum_of(parts) - static_cast<double>(inside) / kPoints) < 2.0 / kPoints);
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const Vec2 half = (to - from) * (0.4999 * parts[j].fraction);
      const Vec2 first = parts[j].middle - half, last = parts[j].middle + half;
      CHECK(std::floor(first.x) == std::floor(last.x));
      CHECK(std::floor(first.y) == std::floor(last.y));
      if (j == 0) continue;
      const Vec2 before = parts[j - 1].middle;
      CHECK((std::floor(before.x) != std::floor(first.x) || std::floor(before.y) != std::floor(first.y)));
    }
  }
  CHECK(within > 500);
}

TEST_CASE("lines along a row, along a column and without a length") {
  CHECK(sum_of(parts_of({1.25, 2.5}, {4.75, 2.5}, 8, 8)) == doctest::Approx(1.0));
  CHECK(parts_of({1.25, 2.5}, {4.75, 2.5}, 8, 8).size() == 4);
  CHECK(parts_of({2.5, 7.5}, {2.5, 3.5}, 8, 8).size() == 5);
  REQUIRE(parts_of({2.5, 7.5}, {2.5, 7.5}, 8, 8).size() == 1);
  CHECK(parts_of({2.5, 7.5}, {2.5, 7.5}, 8, 8).front().fraction == 1.0);
  CHECK(parts_of({2.5, 8.5}, {6.5, 8.5}, 8, 8).empty());
  CHECK(parts_of({-5.0, 3.0}, {-1.0, 4.0}, 8, 8).empty());
}

TEST_CASE("lines of any length, and what is no line, come to an end") {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                   kInfinite = std::numeric_limits<double>::infinity();
  for (const double far : {1e6, 1e12, 1e18, 1e300, kNone, kInfinite})
    for (const Vec2 to : {Vec2{far, 3.0}, Vec2{far, far}, Vec2{far, -far}})
      for (const Vec2 from : {Vec2{1.5, 2.5}, Vec2{-far, 2.5}, Vec2{-far, -far}})
        CHECK(parts_of(from, to, 8, 8).size() <= 18);
  CHECK(sum_of(parts_of({0.0, 2.5}, {1e6, 2.5}, 8, 8)) == doctest::Approx(8e-6));
}
