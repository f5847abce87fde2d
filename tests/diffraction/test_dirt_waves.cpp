// SPDX-License-Identifier: Apache-2.0
// Dirt in a pupil's mask and in its pattern: covered areas by counting, far fields by integrals along outlines, flux.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <random>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/starburst.h"
#include "diffraction/dirt_waves.h"
#include "diffraction/polygon_cover.h"
#include "support/approx.h"
#include "support/inside_polygon.h"
#include "support/sum_of_channel.h"

using namespace contrejour;

namespace {

std::vector<double> cover(int side, const std::vector<Vec2>& polygon) {
  std::vector<double> fractions(static_cast<std::size_t>(side * side));
  PolygonCover cover(side);
  for (int again = 0; again < 2; ++again) {  // the second call replaces the first
    std::fill(fractions.begin(), fractions.end(), 0.0);
    cover.for_each(polygon, [&](std::size_t sample, double fraction) { fractions[sample] += fraction; });
  }
  return fractions;
}

// |integral over a polygon of exp(-i k.x)|^2 (Green's theorem: exact for straight edges).
double power_of(const std::vector<Vec2>& polygon, Vec2 k) {
  std::complex<double> sum;
  for (std::size_t j = 0; j < polygon.size(); ++j) {
    const Vec2 a = polygon[j], b = polygon[(j + 1) % polygon.size()], edge = b - a;
    const double q = 0.5 * dot(k, edge);
    const double sinc = std::abs(q) < 1e-6 ? 1.0 : std::sin(q) / q;
    sum += cross(k, edge) * sinc * std::polar(1.0, -dot(k, (a + b) * 0.5));
  }
  return std::norm(sum) / (dot(k, k) * dot(k, k));
}

constexpr double kRadius_mm = 3.0;

struct DirtyPupil {
  PupilMask mask;
  PupilOutline outline;
};

// A round pupil with strokes in it.
DirtyPupil dirty_pupil(const std::vector<DirtStroke>& strokes, int samples = 510) {
  const IrisOpening opening{Iris{}};
  DirtyPupil pupil{make_mask(grid_over(kRadius_mm, samples), opening, kRadius_mm),
                   {opening, {kRadius_mm, 0.0}, {0.0, kRadius_mm}}};
  const std::vector<float> clean = pupil.mask.amplitude;
  MaskPower power;
  std::vector<DimPolygon> polygons;
  for (const DirtStroke& s : strokes) polygons.push_back({dirt_outline(s), 1.0 - s.opacity});
  dim(pupil.mask, power, polygons);
  PupilDirt dirt{strokes, {1.0, 0.0}, {0.0, 1.0}, 0.0};
  for (std::size_t k = 0; k < clean.size(); ++k) dirt.power_mm2 += static_cast<double>(clean[k]) * power[k];
  dirt.power_mm2 *= pupil.mask.grid.pitch_mm * pupil.mask.grid.pitch_mm;
  pupil.outline.dirt = std::make_shared<const PupilDirt>(dirt);
  return pupil;
}

// Strokes well inside the pupil, with hardly any overlap.
std::vector<DirtStroke> scratches(int count, double length_mm, double width_mm, double angle_rad, double bend_rad) {
  std::mt19937 random(11);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  std::vector<DirtStroke> strokes;
  while (static_cast<int>(strokes.size()) < count) {
    const Vec2 at = Vec2{any(random), any(random)} * kRadius_mm;
    if (length(at) + 0.5 * length_mm > 0.95 * kRadius_mm) continue;
    strokes.push_back({at, angle_rad + 0.02 * any(random), length_mm, width_mm, bend_rad, 1.0});
  }
  return strokes;
}

Image drawn(const DirtyPupil& pupil, double pitch_mm, int side, double f_number = 16.0, const Context& context = {}) {
  const StarburstSettings settings{2.0 * kRadius_mm * f_number, kRadius_mm, pitch_mm, 0.75 * side};
  Image image(side, side);
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  const auto starburst = make_starburst(pupil.mask, &pupil.outline, bands, settings, context);
  REQUIRE(starburst.has_value());
  add_starburst(image, *starburst, {0.5 * side, 0.5 * side}, {1.0, 1.0, 1.0}, context);
  return image;
}

}  // namespace

TEST_CASE("a polygon covers its exact share of every sample, however it lies and however thin it is") {
  std::mt19937 random(5);
  std::uniform_real_distribution<> any(-4.0, 14.0);
  constexpr int kSide = 10, kSub = 40;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Vec2> polygon{{any(random), any(random)}, {any(random), any(random)}, {any(random), any(random)}};
    if (trial % 2 == 0) std::swap(polygon[0], polygon[1]);
    const auto fractions = cover(kSide, polygon);
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        int inside = 0;
        for (int i = 0; i < kSub * kSub; ++i)
          inside += test::inside_polygon(polygon, {column + (i % kSub + 0.5) / kSub, row + (i / kSub + 0.5) / kSub});
        CHECK(std::abs(fractions[static_cast<std::size_t>(row * kSide + column)] - inside / double(kSub * kSub)) <
              0.02);
      }
    }
  }
  // A scratch a thousandth of a sample wide, from beyond one corner to beyond the other.
  const double w = 1e-3;
  const auto thin = cover(kSide, {{-3.0, -3.0}, {13.0, 13.0}, {13.0 - w, 13.0 + w}, {-3.0 - w, -3.0 + w}});
  double sum = 0.0;
  for (const double fraction : thin) sum += fraction;
  CHECK(sum == test::approx(10.0 * 2.0 * w).epsilon(1e-3));
  // Polygons outside, without area, or with coordinates that are not numbers cover nothing.
  for (const auto& nothing : {std::vector<Vec2>{{20, 1}, {30, 1}, {25, 9}}, std::vector<Vec2>{{1, 3}, {9, 3}},
                              std::vector<Vec2>{{1, 1}, {NAN, 2}, {3, 3}}, std::vector<Vec2>{}}) {
    for (const double fraction : cover(kSide, nothing)) CHECK(std::abs(fraction) < 1e-9);
  }
  const auto all = cover(kSide, {{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}});
  CHECK(*std::min_element(all.begin(), all.end()) == test::approx(1.0).epsilon(1e-6));
}

TEST_CASE("dimmed samples lose amplitude and power by what is covered") {
  PupilMask mask{{4, 1.0}, std::vector<float>(16, 1.0F), {}};
  MaskPower power;
  // The right half of the sample above and to the right of the middle.
  dim(mask, power, std::vector<DimPolygon>{{{{0.5, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.5, 1.0}}, 0.25}});
  CHECK(mask.amplitude[1 * 4 + 2] == test::approx(1.0 - 0.5 * 0.5));
  CHECK(power[1 * 4 + 2] == test::approx(1.0 - 0.5 * 0.75));
  CHECK(std::count(power.begin(), power.end(), 1.0F) == 15);
}

TEST_CASE("far fields of scratches and specks are those of their outlines, fringes averaged") {
  const std::vector<DirtStroke> kinds{{{}, 0.4, 3.0, 0.02, 0.0, 1.0},  {{}, 1.9, 3.0, 0.01, 0.15, 1.0},
                                      {{}, 2.2, 1.0, 0.03, -0.3, 1.0}, {{}, 0.0, 0.0, 0.08, 0.0, 1.0},
                                      {{}, 1.0, 0.03, 0.05, 0.0, 1.0}, {{}, 0.8, 2.0, 0.05, 0.0, 0.5}};
  for (std::size_t which = 0; which < kinds.size(); ++which) {
    CAPTURE(which);
    const DirtStroke& stroke = kinds[which];
    const DirtWaves waves(std::span(&stroke, 1));
    const auto outline = dirt_outline(stroke);
    const double taken = std::pow(1.0 - std::sqrt(1.0 - stroke.opacity), 2.0);
    for (const double k : {60.0, 250.0, 900.0}) {
      CAPTURE(k);
      // All directions together, and the streak's fraction of them.
      double sum = 0.0, expected = 0.0, in_fan = 0.0, expected_in_fan = 0.0;
      constexpr int kDirections = 720, kAcross = 5, kDown = 5;
      const double window = kPi / kDirections;
      for (int i = 0; i < kDirections; ++i) {
        const double angle = (i + 0.5) * window;
        double own = 0.0, exact = 0.0;
        const auto direction = waves.along(angle, window);
        for (int j = 0; j < kDown; ++j) {  // a channel's band
          const double kj = k * (1.0 + 0.3 * ((j + 0.5) / kDown - 0.5));
          own += direction.power(kj) / kDown;
          for (int m = 0; m < kAcross; ++m) {
            const double a = angle + window * ((m + 0.5) / kAcross - 0.5);
            exact += taken * power_of(outline, Vec2{std::cos(a), std::sin(a)} * kj) / (kDown * kAcross);
          }
        }
        sum += own;
        expected += exact;
        const double tau = std::remainder(angle - stroke.angle_rad - 0.5 * kPi, kPi);
        if (std::abs(tau) < 0.5 * std::abs(stroke.bend_rad) + 0.02) in_fan += own, expected_in_fan += exact;
      }
      CHECK(sum / expected == test::approx(1.0).epsilon(0.15));
      if (stroke.length_mm > 0.1) {
        CHECK(in_fan / expected_in_fan == test::approx(1.0).epsilon(0.15));
        if (k > 100.0) CHECK(in_fan > 0.8 * sum);
      }
    }
  }
}

TEST_CASE("what dirt takes out of the samples it sends farther: the plane's flux stays") {
  struct Case {
    const char* name;
    std::vector<DirtStroke> strokes;
  };
  std::vector<DirtStroke> dust;
  for (DirtStroke s : scratches(150, 0.0, 0.06, 0.0, 0.0)) dust.push_back(s);
  for (const Case& c : {Case{"none", {}}, Case{"fine scratches", scratches(60, 2.0, 0.004, 0.3, 0.0)},
                        Case{"bent scratches", scratches(30, 3.0, 0.01, 1.0, 0.2)}, Case{"dust", dust}}) {
    CAPTURE(c.name);
    // Pixels of 1 mm: all of the plane within 300 mm.
    const Image image = drawn(dirty_pupil(c.strokes), 1.0, 600);
    for (int channel = 0; channel < 3; ++channel)
      CHECK(test::sum_of_channel(image, channel) == test::approx(1.0).epsilon(2e-3));
  }
}

TEST_CASE("scratches give streaks across them, red outside; far beyond the samples too") {
  const double angle = 0.4;
  const Image image = drawn(dirty_pupil(scratches(25, 3.0, 0.01, angle, 0.0)), 0.02, 1200);
  const auto along = [&](double direction, double from_px, double to_px, int channel) {
    double sum = 0.0;
    for (double r = from_px; r < to_px; r += 0.5)
      for (double off = -0.03; off <= 0.03; off += 0.005)
        sum += image.at(static_cast<int>(600.0 + r * std::cos(direction + off)),
                        static_cast<int>(600.0 - r * std::sin(direction + off)), channel);
    return sum;
  };
  // 8.8 um for each unit of rho: the samples end at 78 pixels.
  for (const double r : {40.0, 120.0, 300.0, 450.0}) {
    CAPTURE(r);
    const double streak = along(angle + 0.5 * kPi, r, 1.2 * r, 1);
    CHECK(streak > 20.0 * along(angle, r, 1.2 * r, 1));
    CHECK(streak > 20.0 * along(angle + 0.25 * kPi, r, 1.2 * r, 1));
  }
  // A slit of 10 um has its first dark fringe at lambda d / w = 5.3 mm for green: red passes it farther out.
  const double red = along(angle + 0.5 * kPi, 200.0, 250.0, 0) / along(angle + 0.5 * kPi, 60.0, 90.0, 0);
  const double blue = along(angle + 0.5 * kPi, 200.0, 250.0, 2) / along(angle + 0.5 * kPi, 60.0, 90.0, 2);
  CHECK(red > 1.2 * blue);
}

TEST_CASE("the pattern goes on from spectrum to far field without a step, and the same on any number of threads") {
  auto strokes = scratches(20, 2.0, 0.02, 1.1, 0.05);
  for (DirtStroke s : scratches(80, 0.0, 0.05, 0.0, 0.0)) strokes.push_back(s);
  const DirtyPupil pupil = dirty_pupil(strokes);
  const Image image = drawn(pupil, 0.01, 800);
  // The mean over all directions, ring by ring; 157 pixels is where the samples end.
  const auto ring = [&](double from, double to) {
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < 800; ++y)
      for (int x = 0; x < 800; ++x)
        if (const double r = std::hypot(x + 0.5 - 400.0, y + 0.5 - 400.0); r >= from && r < to)
          sum += image.at(x, y, 1), count += 1.0;
    return sum / count;
  };
  double before = ring(60.0, 70.0) * std::pow(65.0, 2.0);
  for (double r = 70.0; r < 300.0; r += 10.0) {
    CAPTURE(r);
    const double here = ring(r, r + 10.0) * std::pow(r + 5.0, 2.0);
    CHECK(here / before == test::approx(1.0).epsilon(0.4));
    before = here;
  }
  CHECK(drawn(pupil, 0.05, 100, 16.0, {.threads = 1}).pixels == drawn(pupil, 0.05, 100, 16.0, {.threads = 3}).pixels);
}
