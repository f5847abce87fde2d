// SPDX-License-Identifier: Apache-2.0
// Shadows of dirt out of focus, against Fresnel's integral over the shapes, summed point by point.
#include <cmath>
#include <complex>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "diffraction/straight_edge.h"
#include "render/stop_patterns/dirt_diffraction.h"
#include "support/approx.h"

using namespace contrejour;
using stop_patterns::DirtDiffraction;

namespace {

constexpr double kExtent_mm = 4.0;

// Goodman 2005 eq. 4-17 without exp(i k z): each shape's wave; the caller combines overlapping shapes.
std::complex<double> wave_by_points(const DirtStroke& stroke, Vec2 at, double lambda_z_mm2) {
  const double outer_radius = stroke.outer_radius_mm();
  const int steps = std::max(200, static_cast<int>(2.0 * outer_radius / (0.02 * std::sqrt(lambda_z_mm2))));
  const double pitch = 2.0 * outer_radius / steps;
  std::complex<double> sum = 0.0;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      const Vec2 s = stroke.middle_mm + Vec2{(i + 0.5) * pitch - outer_radius, (j + 0.5) * pitch - outer_radius};
      const Vec2 away = s - at;
      if (stroke.distance_mm(s) < 0.0) sum += std::polar(pitch * pitch, kPi * dot(away, away) / lambda_z_mm2);
    }
  return std::complex<double>(0.0, -1.0) * sum / lambda_z_mm2;
}

DirtDiffraction plane_of(const std::vector<DirtStroke>& strokes, double lambda_z_mm2, double extent_mm = kExtent_mm,
                         double spread = 0.0) {
  return {strokes, extent_mm, lambda_z_mm2, std::make_shared<const StraightEdge>(spread)};
}

std::vector<Vec2> points_about(const DirtStroke& stroke, double outer_radius_mm) {
  std::vector<Vec2> points;
  for (int k = 0; k < 40; ++k) {
    const double angle = 2.4 * k, radius = outer_radius_mm * std::sqrt((k + 0.5) / 40.0);
    points.push_back(stroke.at(0.45 * std::sin(1.7 * k)) + Vec2{radius * std::cos(angle), radius * std::sin(angle)});
  }
  return points;
}

}  // namespace

TEST_CASE("specks and scratches as the integral over them has them [slow]") {
  struct Case {
    DirtStroke stroke;
    double lambda_z_mm2, tolerance;
  };
  const std::vector<Case> cases{
      {{{0.3, -0.2}, 0.4, 0.0, 0.3, 0.0, 1.0}, 0.02, 0.055},   // a disc, n of 1
      {{{0.3, -0.2}, 0.4, 0.0, 0.3, 0.0, 0.6}, 0.1, 0.02},     // of 0.2, more than half opaque
      {{{-0.6, 0.5}, 1.0, 0.15, 0.3, 0.0, 1.0}, 0.05, 0.05},   // longer than wide
      {{{0.1, 0.1}, 0.0, 0.0, 0.8, 0.0, 1.0}, 0.01, 0.06},     // n of 16: its edge
      {{{0.0, 0.2}, 0.7, 2.0, 0.02, 0.0, 1.0}, 0.01, 0.02},    // a thin scratch
      {{{0.0, 0.2}, -0.5, 2.0, 0.2, 0.0, 0.8}, 0.01, 0.04},    // a broad one
      {{{0.1, 0.0}, 0.9, 2.4, 0.05, 1.5, 1.0}, 0.01, 0.05},    // a curved one
  };
  for (const Case& c : cases) {
    CAPTURE(c.lambda_z_mm2);
    CAPTURE(c.stroke.width_mm);
    CAPTURE(c.stroke.length_mm);
    const DirtDiffraction plane = plane_of({c.stroke}, c.lambda_z_mm2, 4000.0 * std::sqrt(c.lambda_z_mm2));
    const double amplitude = 1.0 - std::sqrt(1.0 - c.stroke.opacity);
    double squares = 0.0, smallest = 1.0;
    const auto points = points_about(c.stroke, 0.5 * c.stroke.width_mm + 2.0 * std::sqrt(c.lambda_z_mm2));
    for (const Vec2 at : points) {
      const double expected = std::norm(1.0 - amplitude * wave_by_points(c.stroke, at, c.lambda_z_mm2));
      squares += std::pow(plane.level() * plane.transmission(at, 0.0) - expected, 2.0);
      smallest = std::min(smallest, expected);
    }
    CHECK(smallest < 0.9);
    CHECK(std::sqrt(squares / static_cast<double>(points.size())) < c.tolerance);
  }
}

// A plane too large to be sampled is evaluated directly.
TEST_CASE("samples are what they were sampled from") {
  Dirt dirt;
  dirt.dust_per_cm2 = 80.0;
  dirt.dust_mm = 0.2;
  dirt.scratches_per_cm2 = 30.0;
  dirt.scratch_width_mm = 0.05;
  dirt.scratch_bend_rad = 1.0;
  const auto strokes = dirt_within(dirt, {-kExtent_mm, -kExtent_mm}, {kExtent_mm, kExtent_mm});
  for (const double fringe_unit : {0.05, 0.2, 0.6}) {
    CAPTURE(fringe_unit);
    const DirtDiffraction sampled = plane_of(strokes, fringe_unit * fringe_unit),
                          direct = plane_of(strokes, fringe_unit * fringe_unit, 4000.0 * fringe_unit);
    double squares = 0.0, varied = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const Vec2 at{3.7 * std::sin(1.1 * k), 3.7 * std::sin(1.7 * k + 0.3)};
      // The mean of weak shadows depends on the plane's size.
      const double there = direct.level() * (direct.transmission(at, 0.0) - 1.0) + 1.0;
      squares += std::pow(sampled.level() * (sampled.transmission(at, 0.0) - 1.0) + 1.0 - there, 2.0);
      varied += std::pow(there - 1.0, 2.0);
    }
    CHECK(std::sqrt(squares) < 0.13 * std::sqrt(varied));
  }
}

TEST_CASE("each shape takes as much light as its sharp shadow, near or far, weak or strong") {
  Dirt dirt;
  dirt.dust_per_cm2 = 60.0;
  dirt.dust_mm = 0.15;
  dirt.scratches_per_cm2 = 10.0;
  dirt.scratch_width_mm = 0.03;
  dirt.scratch_length_mm = 0.8;
  dirt.opacity = 0.8;
  const auto strokes = dirt_within(dirt, {-3.0, -3.0}, {3.0, 3.0});
  double covered = 0.0;
  for (const DirtStroke& s : strokes) covered += s.opacity * s.width_mm * (s.length_mm + 0.25 * kPi * s.width_mm);
  for (const double fringe_unit : {0.03, 0.1, 0.3, 1.0}) {
    CAPTURE(fringe_unit);
    const DirtDiffraction plane = plane_of(strokes, fringe_unit * fringe_unit, 5.0, 0.05);
    constexpr int kSide = 700;
    double sum = 0.0;
    for (int k = 0; k < kSide * kSide; ++k)
      sum += plane.level() *
             plane.transmission({(k % kSide + 0.5) * 10.0 / kSide - 5.0, (k / kSide + 0.5) * 10.0 / kSide - 5.0}, 0.0);
    CHECK(100.0 * (1.0 - sum / (kSide * kSide)) == test::approx(covered).epsilon(0.06));
  }
}

TEST_CASE("a place that is said to be clean is") {
  Dirt dirt;
  dirt.dust_per_cm2 = 20.0;
  const auto strokes = dirt_within(dirt, {-kExtent_mm, -kExtent_mm}, {kExtent_mm, kExtent_mm});
  const DirtDiffraction plane = plane_of(strokes, 0.002);
  int clean = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec2 at{3.7 * std::sin(1.1 * k), 3.7 * std::sin(1.7 * k + 0.3)};
    if (!plane.is_clean(at, 0.1)) continue;
    ++clean;
    for (int j = 0; j < 16; ++j)
      CHECK(plane.transmission(at + Vec2{0.1 * std::cos(0.4 * j), 0.1 * std::sin(0.4 * j)}, 0.0) ==
            test::approx(1.0).epsilon(0.004));
  }
  CHECK(clean > 100);
}
