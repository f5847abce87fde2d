// SPDX-License-Identifier: Apache-2.0
// The far power spectrum of openings against plain contour sums, and the special functions against quadrature.
#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "diffraction/edge_waves.h"
#include "diffraction/special_functions.h"
#include "diffraction/uneven_edges.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

// |integral over the opening of exp(-i k u.x)|^2 by Green's theorem, the outline cut into short straight pieces.
double contour_power(const IrisOpening& opening, double k, double angle) {
  const Vec2 u{std::cos(angle), std::sin(angle)};
  std::complex<double> sum = 0.0;
  for (const IrisEdge& edge : opening.edges()) {
    const int pieces = edge.bound.straight() ? 1 : static_cast<int>(2.0 * std::sqrt(k) + 20.0);
    const double first = std::atan2(edge.start.y - edge.bound.centre.y, edge.start.x - edge.bound.centre.x);
    double span = std::atan2(edge.end.y - edge.bound.centre.y, edge.end.x - edge.bound.centre.x) - first;
    if (span <= 0.0) span += 2.0 * kPi;
    const auto at = [&](int i) {
      const double t = first + span * i / pieces;
      return edge.bound.centre + Vec2{std::cos(t), std::sin(t)} * edge.bound.radius;
    };
    for (int i = 0; i < pieces; ++i) {
      const Vec2 a = edge.bound.straight() ? edge.start : at(i), b = edge.bound.straight() ? edge.end : at(i + 1);
      const double q = 0.5 * k * dot(u, b - a);
      const double sinc = std::abs(q) < 1e-9 ? 1.0 : std::sin(q) / q;
      sum += cross(u, b - a) * sinc * std::polar(1.0, -0.5 * k * dot(u, a + b));
    }
  }
  return std::norm(sum) / (k * k);
}

// The mean over wavelengths, as a colour channel has it, normalised to k by k^-3, and over a window of directions.
double averaged(const IrisOpening& opening, double k, double angle, double window) {
  double sum = 0.0;
  constexpr int kSteps = 97, kAngles = 4;
  for (int i = 0; i < kSteps; ++i) {
    const double scale = 0.88 + 0.24 * (i + 0.5) / kSteps;
    for (int j = 0; j < kAngles; ++j)
      sum += std::pow(scale, 3) * contour_power(opening, k * scale, angle + window * ((j + 0.5) / kAngles - 0.5));
  }
  return sum / (kSteps * kAngles);
}

}  // namespace

TEST_CASE("Fresnel integrals and the integral of sinc^2") {
  double c = 0.0, s = 0.0, q = 0.0;
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 100000; ++i) {
    const double x = (i + 0.5) * kStep;
    c += kStep * std::cos(0.5 * kPi * x * x);
    s += kStep * std::sin(0.5 * kPi * x * x);
    q += kStep * std::pow(std::sin(x) / x, 2);
    if (i % 2503 != 0) continue;
    const FresnelIntegrals f = fresnel_integrals(x + 0.5 * kStep), g = fresnel_integrals(-x - 0.5 * kStep);
    CHECK(std::abs(f.c - c) < 2.5e-3);
    CHECK(std::abs(f.s - s) < 2.5e-3);
    CHECK(g.c == -f.c);
    CHECK(std::abs(integral_of_sinc_squared(x + 0.5 * kStep) - q) < 1e-5);
  }
  CHECK(integral_of_sinc_squared(1e6) == test::approx(0.5 * kPi).epsilon(1e-5));
}

TEST_CASE("a circle's far spectrum is the mean of Airy's rings") {
  const EdgeWaves edges(IrisOpening(Iris{}));
  CHECK(edges.along(0.4, 1e-3).power(300.0) * std::pow(300.0, 3) == test::approx(4.0 * kPi));
}

TEST_CASE("edges and corners send what the contour integral says [slow]") {
  for (const Iris& iris :
       {Iris{6, 0.1}, Iris{5, 0.3, 0.0, 1.0, 0.06, 5}, Iris{7, 0.0, 0.4}, Iris{8, 0.2, 0.15, 1.03}}) {
    const IrisOpening opening(iris);
    const EdgeWaves edges(opening);
    double worst = 0.0, off = 0.0, sum = 0.0, expected_sum = 0.0;
    const double k = 400.0, window = kPi / 120;  // the windows cover half a turn
    for (int i = 0; i < 120; ++i) {
      const double angle = window * (i + 0.5);
      const double expected = averaged(opening, k, angle, window), found = edges.along(angle, window).power(k);
      worst = std::max(worst, std::abs(std::log(found / expected)));
      off += std::abs(found - expected);
      sum += found;
      expected_sum += expected;
    }
    CHECK(sum / expected_sum == test::approx(1.0).epsilon(3e-3));
    CHECK(off / expected_sum < 0.12);  // fringes at the ends of the fans
    // Only in the gaps between fans, which are a hundred times darker, where the waves of several corners are in phase.
    CHECK(worst < std::log(2.0));
  }
}

TEST_CASE("arcs that meet nearly without a corner are nearly one: no dark line there [slow]") {
  for (const double curvature : {0.9, 0.97, 0.9999}) {
    const IrisOpening opening(Iris{9, 0.0, curvature});
    const EdgeWaves edges(opening);
    for (const double k : {400.0, 1600.0}) {
      CAPTURE(curvature);
      CAPTURE(k);
      double worst = 0.0, off = 0.0, sum = 0.0, expected_sum = 0.0;
      constexpr int kDirections = 80;
      const double window = kPi / 9.0 / kDirections;  // so that the windows repeat with the pattern
      for (int i = 0; i < kDirections; ++i) {
        const double angle = window * (i + 0.5);
        const double expected = averaged(opening, k, angle, window), found = edges.along(angle, window).power(k);
        worst = std::max(worst, std::abs(found - expected));
        off += std::abs(found - expected) / kDirections;
        sum += found / kDirections;
        expected_sum += expected / kDirections;
      }
      CHECK(sum / expected_sum == test::approx(1.0).epsilon(0.015));
      CHECK(off / expected_sum < 0.05);
      CHECK(worst / expected_sum < 0.15);
    }
  }
}

// Arcs whose normals turn by half a turn or nearly: both ends may be at right angles to a direction at once.
TEST_CASE("a circle cut by another one: two fans, no direction brighter than a whole circle's") {
  for (const Vec2 centre : {Vec2{-0.15, -0.07}, Vec2{0.6, 0.1}, Vec2{-0.05, 0.0}}) {
    IrisBound cut;
    cut.centre = centre;
    cut.radius = 1.0427;
    const IrisOpening opening(Iris{}, std::span(&cut, 1));
    REQUIRE(opening.edges().size() == 2);
    const EdgeWaves edges(opening);
    for (const double k : {100.0, 1000.0, 30000.0}) {
      double brightest = 0.0;
      for (int i = 0; i < 7200; ++i)
        brightest = std::max(brightest, edges.along(kPi * i / 7200, kPi / 7200).power(k) * std::pow(k, 3));
      CHECK(brightest < 1.5 * 4.0 * kPi * cut.radius);  // the first fringe of a fan's edge is 1.37 of its level
      CHECK(brightest > 0.9 * 4.0 * kPi);
    }
  }
}

namespace {

// The smallest value over the directions, and the largest step between two neighbours, both relative to the mean; and
// the mean.
struct Evenness {
  double darkest = 0.0, step = 0.0, mean = 0.0;
};
Evenness evenness(const UnevenEdges& edges, double k) {
  constexpr int kDirections = 2880;
  std::vector<double> power;
  Evenness found;
  for (int i = 0; i < kDirections; ++i) {
    power.push_back(edges.along(kPi * (i + 0.5) / kDirections, kPi / kDirections).power(k));
    found.mean += power.back() / kDirections;
  }
  found.darkest = *std::min_element(power.begin(), power.end()) / found.mean;
  for (std::size_t i = 1; i < power.size(); ++i)
    found.step = std::max(found.step, std::abs(power[i] - power[i - 1]) / found.mean);
  return found;
}

}  // namespace

// Nine blades of curvature 0.5 have fans 19.7 degrees wide at intervals of 20, alternately from blades on either side.
TEST_CASE("fans that end where others begin leave a dark line between exact arcs, and none between uneven ones") {
  const Iris iris{9, 0.0, 0.5};
  const IrisOpening opening(iris);
  const double boundary = kPi / 18.0;  // half way between two fans
  CHECK(averaged(opening, 1600.0, boundary, 1e-3) * std::pow(1600.0, 3) / (2.0 * kPi * 2.0) < 0.55);
  const double spread = iris_slope_spread_rad(iris);
  CHECK(spread == test::approx(iris.slope_spread * 2.0 * std::asin(0.5 * std::sin(kPi / 9.0))));
  for (const double k : {1600.0, 6400.0, 25600.0}) {
    CAPTURE(k);
    const Evenness exact = evenness(UnevenEdges(opening, 0.0, {}), k),
                   uneven = evenness(UnevenEdges(opening, spread, {}), k);
    CHECK(exact.darkest < 0.55);
    CHECK(uneven.darkest > 0.85);
    CHECK(uneven.mean / exact.mean == test::approx(1.0).epsilon(1e-3));
    CHECK(uneven.step < 0.02);
  }
  // Straight edges remain exact, and so do arcs that form one circle.
  CHECK(iris_slope_spread_rad(Iris{9}) == 0.0);
  CHECK(iris_slope_spread_rad(Iris{}) == 0.0);
  const Iris nearly_round{7, 0.0, 0.9999};
  const UnevenEdges round(IrisOpening(nearly_round), iris_slope_spread_rad(nearly_round), {});
  CHECK(evenness(round, 1600.0).darkest > 0.9);
  CHECK(evenness(round, 1600.0).mean * std::pow(1600.0, 3) == test::approx(4.0 * kPi).epsilon(0.05));
}
