// SPDX-License-Identifier: Apache-2.0
// The opening of an iris against straight blades, closed forms and brute force.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/iris.h"
#include "ghosts/iris_shape.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

Vec2 polar(double r, double angle) { return {r * std::cos(angle), r * std::sin(angle)}; }

// The area by counting points of a fine grid.
double counted_area(const Iris& iris) {
  constexpr int kSide = 600;
  int inside = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i)
      inside += iris_distance(iris, {2.2 * (i + 0.5) / kSide - 1.1, 2.2 * (j + 0.5) / kSide - 1.1}) <= 0.0;
  return inside * 2.2 * 2.2 / (kSide * kSide);
}

// The nearest of many points on the outline, found by walking each ray from the centre to the edge.
double brute_distance(const Iris& iris, Vec2 p) {
  double nearest = 1e9;
  for (int k = 0; k < 4000; ++k) {
    const double angle = 2.0 * kPi * k / 4000;
    double low = 0.0, high = 1.2;
    for (int step = 0; step < 25; ++step)
      (iris_distance(iris, polar(0.5 * (low + high), angle)) <= 0.0 ? low : high) = 0.5 * (low + high);
    nearest = std::min(nearest, length(p - polar(low, angle)));
  }
  return iris_distance(iris, p) <= 0.0 ? -nearest : nearest;
}

const std::vector<Iris> kIrises{{},
                                {5, 0.3},
                                {8, 0.1, 0.0, 1.05},
                                {6, 0.2, 0.5},
                                {9, 0.0, 1.0},
                                {7, 0.4, 0.3, 1.02, 0.08, 3},
                                {5, 0.1, 0.2, 1.0, 0.0, 0, {0.1, -0.1, 0.05}}};

}  // namespace

TEST_CASE("straight blades give the distances that renderers use") {
  for (const int blades : {3, 5, 6, 8, 11}) {
    const Iris iris{blades, 0.37};
    const IrisShape shape(iris);
    const IrisOpening opening(iris);
    for (int k = 0; k < 500; ++k) {
      const Vec2 p = polar(0.0026 * k, 2.399963 * k);
      const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y);
      float expected = 0.0F;
      shape.distances(&x, &y, 1, &expected);
      CHECK(iris_distance(iris, p) == test::approx(expected).epsilon(1e-5).scale(1.0));
      CHECK(opening.bound_distance(p) == test::approx(expected).epsilon(1e-5).scale(1.0));
      if (expected <= 0.0F)
        CHECK(opening.distance(p) == test::approx(expected).epsilon(1e-5).scale(1.0));
      else
        CHECK(opening.distance(p) >= expected - 1e-5);
    }
  }
}

TEST_CASE("the opening's distance is Euclidean everywhere [slow]") {
  for (const Iris& iris : kIrises) {
    const IrisOpening opening(iris);
    for (int k = 0; k < 9; ++k) {
      const Vec2 p = polar(0.13 * k, 1.7 * k);
      CHECK(opening.distance(p) == test::approx(brute_distance(iris, p)).epsilon(1e-3));
    }
  }
}

TEST_CASE("area and perimeter") {
  for (const Iris& iris : kIrises) {
    const IrisOpening opening(iris);
    CHECK(opening.area() == test::approx(counted_area(iris)).epsilon(2e-3));
    CHECK(iris_area_fraction(iris) == test::approx(opening.area() / kPi));
  }
  CHECK(IrisOpening(Iris{6}).perimeter() == test::approx(6.0));
  CHECK(IrisOpening(Iris{}).perimeter() == test::approx(2.0 * kPi));
}

TEST_CASE("edges of the circle's own curvature are the circle; blades far out are hidden") {
  for (const Iris& iris : {Iris{9, 0.2, 1.0}, Iris{6, 0.0, 0.0, 1.0 / std::cos(kPi / 6) + 1e-9}}) {
    const IrisOpening opening(iris);
    CHECK(opening.edges().size() == 1);
    CHECK(opening.area() == test::approx(kPi));
  }
}

TEST_CASE("an iris between open and closed shows rim and blades in turn") {
  CHECK(IrisOpening(Iris{8}).edges().size() == 8);
  CHECK(IrisOpening(Iris{8, 0.0, 0.0, 1.05}).edges().size() == 16);
}

TEST_CASE("asymmetric blades: seeded, the same every time, never beyond the rim") {
  const Iris a{7, 0.0, 0.2, 1.0, 0.1, 1}, b{7, 0.0, 0.2, 1.0, 0.1, 2};
  CHECK(IrisOpening(a).area() == IrisOpening(a).area());
  CHECK(IrisOpening(a).area() != test::approx(IrisOpening(b).area()).epsilon(1e-4));
  for (int k = 0; k < 100; ++k) CHECK(iris_distance(a, polar(1.0, 0.1 * k)) >= -1e-12);
}

TEST_CASE("another aperture cuts a lens-shaped opening") {
  // Two unit circles a radius apart: 2 pi / 3 - sqrt(3) / 2.
  const std::array<IrisBound, 1> cut{IrisBound{{}, 0.0, {1.0, 0.0}, 1.0}};
  const IrisOpening lens(Iris{}, cut);
  CHECK(lens.edges().size() == 2);
  CHECK(lens.area() == test::approx(2.0 * kPi / 3.0 - 0.5 * std::sqrt(3.0)));
  CHECK(lens.distance({0.5, 0.0}) == test::approx(-0.5));
  const std::array<IrisBound, 1> away{IrisBound{{}, 0.0, {3.0, 0.0}, 1.0}};
  CHECK(IrisOpening(Iris{}, away).closed());
}
