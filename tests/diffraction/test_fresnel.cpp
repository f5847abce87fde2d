// SPDX-License-Identifier: Apache-2.0
// Fresnel patterns against Fresnel integrals, Lommel's closed form on the axis, both limits, and energy.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/fraunhofer.h"
#include "contrejour/expert/fresnel.h"
#include "diffraction/fresnel_methods.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

PupilMask circle(int samples = 512) { return make_mask(grid_over(1.0, samples), IrisOpening(Iris{}), 1.0); }

double at_axis(const FresnelPattern& pattern) {  // of odd side
  return pattern.irradiance[static_cast<std::size_t>(pattern.side / 2 * pattern.side + pattern.side / 2)];
}

// Behind a straight edge: Born & Wolf 8.7.3, w = x sqrt(2 / (lambda z)) into the light, by quadrature.
double edge_irradiance(double w) {
  double c = 0.5, s = 0.5;
  constexpr double kStep = 1e-4;
  const int steps = static_cast<int>(std::abs(w) / kStep);
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) * kStep;
    c += std::copysign(kStep, w) * std::cos(0.5 * kPi * t * t);
    s += std::copysign(kStep, w) * std::sin(0.5 * kPi * t * t);
  }
  return 0.5 * (c * c + s * s);
}

}  // namespace

TEST_CASE("a circle on its axis: 4 sin^2(pi F / 2)") {
  for (const double f : {0.3, 1.0, 1.5, 2.0, 3.0, 5.5, 8.0, 13.0, 40.5, 51.0}) {
    const FresnelPattern pattern = fresnel_pattern(circle(1024), 1.0, {f, 65, 0.05});
    CHECK(at_axis(pattern) == test::approx(4.0 * std::pow(std::sin(0.5 * kPi * f), 2)).epsilon(0.02).scale(1.0));
  }
}

TEST_CASE("a straight edge: the first overshoot is 1.370 and where the Fresnel integrals have it") {
  // One side of a square; the light from the other sides has fringes finer than the samples here, which average out.
  const double f = 400.0;
  const PupilMask mask =
      make_mask({1024, 2.2 / 1024}, [](Vec2 p) { return std::max(std::abs(p.x), std::abs(p.y)) - 1.0; });
  const FresnelPattern pattern = fresnel_pattern(mask, 1.0, {f, 2001, 1.25});
  const double pitch = 2.5 / 2001;
  double best = 0.0, best_x = 0.0;
  for (int k = 1400; k < 2001; ++k) {
    const double value = pattern.irradiance[static_cast<std::size_t>(1000 * 2001 + k)];
    if (value > best && (k - 1000) * pitch > 0.85) best = value, best_x = (k - 1000) * pitch;
  }
  // Born & Wolf figure 8.37: the maximum is at w = 1.2172.
  CHECK(best == test::approx(1.370).epsilon(0.005));
  CHECK((1.0 - best_x) * std::sqrt(2.0 * f) == test::approx(1.2172).epsilon(0.005));
  for (const double w : {-1.5, -0.5, 0.0, 0.6, 1.2, 1.9}) {
    const int k = static_cast<int>(std::lround((1.0 - w / std::sqrt(2.0 * f)) / pitch));
    const double there = (1.0 - k * pitch) * std::sqrt(2.0 * f);
    CHECK(pattern.irradiance[static_cast<std::size_t>(1000 * 2001 + 1000 + k)] ==
          test::approx(edge_irradiance(there)).epsilon(0.02).scale(0.5));
  }
}

TEST_CASE("near and far agree where both hold") {
  const PupilMask mask = make_mask(grid_over(1.0, 512), IrisOpening(Iris{6, 0.2, 0.3}), 1.0);
  for (const double f : {12.0, 30.0, 45.0}) {
    const double extent = fresnel_extent(f);
    const auto near = fresnel_near(mask, 1.0, f, 201, extent, {}), far = fresnel_far(mask, 1.0, f, 201, extent, {});
    double worst = 0.0;
    for (std::size_t k = 0; k < near.size(); ++k) worst = std::max(worst, std::abs(near[k] - far[k]));
    CHECK(worst < 0.03);
  }
}

TEST_CASE("F = 2: light spreads, none is lost, no ripple far out") {
  const PupilMask mask = circle();
  const FresnelPattern pattern = fresnel_pattern(mask, 1.0, {2.0, 801, 20.0});
  // Airy's tail at rho = 2 F x, over a square: see test_starburst.cpp.
  const double outside = 2.0 / (kPi * kPi * 2.0 * 2.0 * 20.0) * std::sqrt(8.0) / kPi;
  CHECK(pattern.flux * mask.open_area_mm2() / kPi + outside == test::approx(1.0).epsilon(5e-4));
  double last = 1.0;
  for (double r = 3.0; r < 19.0; r += 0.5) {  // the brightest ring of each half radius decreases as r^-3
    double brightest = 0.0;
    for (int k = 0; k < 801; ++k) {
      const double x = (k - 400) * 40.0 / 801;
      if (x >= r && x < r + 0.5)
        brightest = std::max(brightest, pattern.irradiance[static_cast<std::size_t>(400 * 801 + k)]);
    }
    CHECK(brightest < 0.6 / (r * r * r));
    CHECK(brightest < last * 1.1);
    last = brightest;
  }
}

TEST_CASE("the flux within the extent that is chosen, at any F") {
  for (const double f : {0.05, 0.5, 2.0, 10.0, 31.0, 33.0, 100.0, 1000.0}) {
    const FresnelPattern pattern = fresnel_pattern(circle(), 1.0, {f, 1201});
    CHECK(pattern.flux > 0.97);
    CHECK(pattern.flux < 1.003);
    CHECK(pattern.extent == fresnel_extent(f));
  }
}

TEST_CASE("F -> 0 is Fraunhofer's pattern") {
  const double f = 0.01;
  const PupilMask mask = make_mask(grid_over(1.0, 256), IrisOpening(Iris{5, 0.3}), 1.0);
  const FresnelPattern pattern = fresnel_pattern(mask, 1.0, {f, 301});
  // z = a^2 / (lambda F), a = 1 mm.
  const double distance_mm = 1.0 / (500e-6 * f);
  const FraunhoferPattern far =
      fraunhofer_pattern(mask, {distance_mm, 500.0, mask.open_area_mm2(), {301, 2.0 * pattern.extent / 301}}).value();
  const double peak = *std::max_element(pattern.irradiance.begin(), pattern.irradiance.end());
  double worst = 0.0;
  for (std::size_t k = 0; k < pattern.irradiance.size(); ++k)
    worst = std::max(worst, std::abs(pattern.irradiance[k] - far.irradiance_per_mm2[k]));
  CHECK(worst < 1e-3 * peak);
}

TEST_CASE("F -> infinity is the sharp mask") {
  const PupilMask mask = make_mask(grid_over(1.0, 256), IrisOpening(Iris{7, 0.3, 0.2}), 1.0);
  for (const double f : {1e7, std::numeric_limits<double>::infinity()}) {
    const FresnelPattern pattern = fresnel_pattern(mask, 1.0, {f, 258, 258.0 / 256.0});
    double worst = 0.0;
    for (std::size_t k = 0; k < pattern.irradiance.size(); ++k)
      worst = std::max(worst, std::abs(pattern.irradiance[k] - std::pow(mask.amplitude[k], 2)));
    CHECK(worst < 2e-3);
  }
}

TEST_CASE("a system's Fresnel number") {
  CHECK(fresnel_number(2.0, 1.0, 1000.0, 500.0) == test::approx(8.0));  // free space: a^2 / (lambda z)
  CHECK(fresnel_number(2.0, -0.5, 1000.0, 500.0) == test::approx(4.0));
  CHECK(std::isinf(fresnel_number(2.0, 0.7, 0.0, 500.0)));
}
