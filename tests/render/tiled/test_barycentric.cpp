// SPDX-License-Identifier: Apache-2.0
// The five interpolations of bodonyi2023 3.4, in double.
#include <array>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "render/tiled/barycentric-inl.h"
#include "support/approx.h"

namespace {

namespace k = contrejour::kernels::HWY_NAMESPACE;
using Quad = k::Quad<double>;

struct Point {
  double x, y;
};

struct Method {
  const char* name;
  std::array<double, 4> (*at)(const Quad&, Point);  // coordinates that sum to one
  bool exact;                                       // exact for linear functions in any convex quadrilateral
};

template <template <class> class Kind>
std::array<double, 4> coordinates(const Quad& quad, Point p) {
  const auto weights = Kind<double>(quad).at(k::relative_to(quad, p.x, p.y));
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = weights.w[i] / weights.total;
  return out;
}

constexpr std::array kMethods{Method{"triangle", coordinates<k::TriangleByMatrix>, true},
                              Method{"homogeneous triangle", coordinates<k::TriangleByCrossProduct>, true},
                              Method{"mean value", coordinates<k::MeanValue>, true},
                              Method{"Wachspress", coordinates<k::Wachspress>, true},
                              Method{"Loop-DeRose", coordinates<k::LoopDeRose>, false}};

// Convex: corners on a circle, then stretched and sheared.
Quad random_quad(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double stretch = 0.2 + 3.0 * unit(random);
  const double shear = unit(random) - 0.5;
  Quad quad;
  for (int i = 0; i < 4; ++i) {
    const double angle = 1.5707963 * (i + 0.8 * unit(random));
    quad.x[i] = 7.0 + stretch * std::cos(angle) + shear * std::sin(angle);
    quad.y[i] = -3.0 + std::sin(angle);
  }
  return quad;
}

Point random_point(const Quad& quad, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.01, 1.0);
  Point p{0.0, 0.0};
  double total = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double w = unit(random);
    p.x += w * quad.x[i];
    p.y += w * quad.y[i];
    total += w;
  }
  return {p.x / total, p.y / total};
}

double interpolated(const std::array<double, 4>& c, const double (&value)[4]) {
  return c[0] * value[0] + c[1] * value[1] + c[2] * value[2] + c[3] * value[3];
}

}  // namespace

TEST_CASE("coordinates lie in 0..1, sum to one, and give a point back its own place") {
  std::mt19937 random(7);
  for (int n = 0; n < 2000; ++n) {
    const Quad quad = random_quad(random);
    const Point p = random_point(quad, random);
    for (const Method& method : kMethods) {
      CAPTURE(method.name);
      const auto c = method.at(quad, p);
      CHECK(c[0] + c[1] + c[2] + c[3] == contrejour::test::approx(1.0).epsilon(1e-12));
      for (const double w : c) CHECK(w >= -1e-12);
      if (!method.exact) continue;
      CHECK(interpolated(c, quad.x) == contrejour::test::approx(p.x).epsilon(1e-9));
      CHECK(interpolated(c, quad.y) == contrejour::test::approx(p.y).epsilon(1e-9));
    }
  }
}

TEST_CASE("in a parallelogram all of them reproduce linear functions, and Wachspress and Loop-DeRose are one") {
  const Quad quad{{0.0, 4.0, 5.0, 1.0}, {0.0, 1.0, 3.0, 2.0}};
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) {
    const Point p = random_point(quad, random);
    for (const Method& method : kMethods) {
      CAPTURE(method.name);
      const auto c = method.at(quad, p);
      CHECK(interpolated(c, quad.x) == contrejour::test::approx(p.x).epsilon(1e-9));
      CHECK(interpolated(c, quad.y) == contrejour::test::approx(p.y).epsilon(1e-9));
    }
    const auto wachspress = kMethods[3].at(quad, p);
    const auto loop = kMethods[4].at(quad, p);
    for (std::size_t i = 0; i < 4; ++i) CHECK(wachspress[i] == contrejour::test::approx(loop[i]).epsilon(1e-12));
  }
}

TEST_CASE("at a corner and along an edge only the corners there count") {
  const Quad quad{{0.0, 4.0, 5.0, 0.5}, {0.0, 1.0, 3.0, 2.0}};
  for (const Method& method : kMethods) {
    CAPTURE(method.name);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      CHECK(method.at(quad, {quad.x[i], quad.y[i]})[i] == contrejour::test::approx(1.0));
      const auto c = method.at(quad, {0.25 * quad.x[i] + 0.75 * quad.x[j], 0.25 * quad.y[i] + 0.75 * quad.y[j]});
      CHECK(c[i] + c[j] == contrejour::test::approx(1.0).epsilon(1e-9));
      if (method.exact) CHECK(c[j] == contrejour::test::approx(0.75).epsilon(1e-9));
    }
  }
}

TEST_CASE("two neighbours never both hold a point beside their edge, in float too") {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int n = 0; n < 20000; ++n) {
    const float ax = 1900.0F + unit(random), ay = 700.0F + unit(random);
    const float bx = 1900.0F + unit(random), by = 700.0F + unit(random);
    const float t = unit(random);
    const float x = ax + t * (bx - ax), y = ay + t * (by - ay);  // on the edge but for rounding
    const k::Quad<float> one{{ax, bx, bx, ax}, {ay, by, by, ay}};
    const k::Quad<float> other{{bx, ax, ax, bx}, {by, ay, ay, by}};
    CHECK(k::relative_to(one, x, y).edge[0] == -k::relative_to(other, x, y).edge[0]);
  }
}
