// SPDX-License-Identifier: Apache-2.0
// Fraunhofer patterns in absolute units: Airy's for a circle, a rectangle's sinc, and flux.
#include <cmath>
#include <complex>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/fraunhofer.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

PupilMask circle(double radius_mm, int samples = 400) {
  return make_mask(grid_over(radius_mm, samples), IrisOpening(Iris{}), radius_mm);
}

double flux_of(const FraunhoferPattern& pattern) {
  double sum = 0.0;
  for (const double e : pattern.irradiance_per_mm2) sum += e;
  return sum * pattern.grid.pitch_mm * pattern.grid.pitch_mm;
}

// The value along +x from the middle of a pattern of odd side.
double at_radius(const FraunhoferPattern& pattern, double r_mm) {
  const double position = r_mm / pattern.grid.pitch_mm;
  const int k = static_cast<int>(position), middle = pattern.grid.side / 2;
  const auto value = [&](int i) {
    return pattern.irradiance_per_mm2[static_cast<std::size_t>(middle * pattern.grid.side + middle + i)];
  };
  return value(k) + (position - k) * (value(k + 1) - value(k));
}

double first_minimum(const FraunhoferPattern& pattern) {
  int k = 1;
  const int middle = pattern.grid.side / 2;
  const double* row = pattern.irradiance_per_mm2.data() + middle * pattern.grid.side + middle;
  while (row[k + 1] < row[k]) ++k;
  // The minimum of a parabola through the three lowest values.
  const double a = row[k - 1], b = row[k], c = row[k + 1];
  return (k + 0.5 * (a - c) / (a - 2.0 * b + c)) * pattern.grid.pitch_mm;
}

}  // namespace

TEST_CASE("a circular pupil gives Airy's pattern in absolute units") {
  for (const double f_number : {2.8, 16.0}) {
    const double radius_mm = 50.0 / (2.0 * f_number), lambda_n_mm = 550e-6 * f_number;
    const FraunhoferPattern pattern =
        fraunhofer_pattern(circle(radius_mm), {50.0, 550.0, 3.0, {401, 0.02 * lambda_n_mm}}).value();
    CHECK(first_minimum(pattern) / (1.2197 * lambda_n_mm) == test::approx(1.0).epsilon(2.5e-3));
    // Born & Wolf 8.5.2: E(0) = flux A / (lambda d)^2, E / E(0) = (2 J1(v) / v)^2, v = pi r / (lambda N).
    const double peak = 3.0 * kPi * radius_mm * radius_mm / std::pow(550e-6 * 50.0, 2);
    CHECK(at_radius(pattern, 0.0) == test::approx(peak).epsilon(3e-3));
    for (const double r : {0.4, 0.9, 1.6, 2.7, 3.3}) {
      const double v = kPi * r;
      CHECK(at_radius(pattern, r * lambda_n_mm) / peak ==
            test::approx(std::pow(2.0 * std::cyl_bessel_j(1.0, v) / v, 2)).epsilon(0.02).scale(0.02));
    }
  }
}

TEST_CASE("the plane gets the flux that is given") {
  // Airy: 1 - E(rho) = 2 / (pi^2 rho) on average beyond a square's 2.2 / 1.96 of its half side.
  const FraunhoferPattern pattern =
      fraunhofer_pattern(circle(2.0, 900), {50.0, 550.0, 7.0, {1601, 0.25 * 550e-6 * 12.5}}).value();
  const double half = 0.25 * 800.0, outside = 2.0 / (kPi * kPi * half) * (2.0 * std::sqrt(2.0) / kPi);
  CHECK(flux_of(pattern) / 7.0 + outside == test::approx(1.0).epsilon(7e-4));
}

TEST_CASE("half the f-number, half the width") {
  const double wide = first_minimum(fraunhofer_pattern(circle(2.0), {50.0, 550.0, 1.0, {301, 0.2e-3}}).value());
  const double narrow = first_minimum(fraunhofer_pattern(circle(4.0), {50.0, 550.0, 1.0, {301, 0.1e-3}}).value());
  CHECK(wide / narrow == test::approx(2.0).epsilon(2e-3));
}

TEST_CASE("a rectangle's pattern is the product of two sincs, wider where the opening is narrower") {
  const PupilMask mask =
      make_mask({256, 0.02}, [](Vec2 p) { return std::max(std::abs(p.x) - 0.6, std::abs(p.y) - 1.8); });
  const FraunhoferPattern pattern = fraunhofer_pattern(mask, {50.0, 500.0, 1.0, {201, 1e-3}}).value();
  const double lambda_d = 500e-6 * 50.0;
  const auto sinc2 = [](double x) { return x == 0.0 ? 1.0 : std::pow(std::sin(kPi * x) / (kPi * x), 2); };
  for (const int x : {0, 7, 19, 40}) {
    for (const int y : {0, 3, 11, 30}) {
      const double expected =
          1.2 * 3.6 / (lambda_d * lambda_d) * sinc2(1.2 * x * 1e-3 / lambda_d) * sinc2(3.6 * y * 1e-3 / lambda_d);
      CHECK(pattern.irradiance_per_mm2[static_cast<std::size_t>((100 - y) * 201 + 100 + x)] ==
            test::approx(expected).epsilon(0.01).scale(20.0));
    }
  }
}

TEST_CASE("a wedge of phase moves the pattern") {
  PupilMask mask = circle(2.0, 200);
  mask.phase_rad.resize(mask.amplitude.size());
  for (int row = 0; row < mask.grid.side; ++row)
    for (int column = 0; column < mask.grid.side; ++column)  // a wave of 10 periods a mm towards +x, 5 towards +y
      mask.phase_rad[static_cast<std::size_t>(row * mask.grid.side + column)] = static_cast<float>(
          2.0 * kPi * (10.0 * mask.grid.position_mm(column, row).x + 5.0 * mask.grid.position_mm(column, row).y));
  const FraunhoferPattern pattern = fraunhofer_pattern(mask, {50.0, 500.0, 1.0, {801, 1e-3}}).value();
  std::size_t brightest = 0;
  for (std::size_t k = 0; k < pattern.irradiance_per_mm2.size(); ++k)
    if (pattern.irradiance_per_mm2[k] > pattern.irradiance_per_mm2[brightest]) brightest = k;
  CHECK(static_cast<int>(brightest % 801) - 400 == 250);  // lambda d f = 0.25 mm
  CHECK(400 - static_cast<int>(brightest / 801) == 125);
}
