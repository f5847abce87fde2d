// SPDX-License-Identifier: Apache-2.0
// Dirt: its statistics against the requested ones, its shapes against brute force, its motion, invalid numbers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/dirt.h"
#include "support/approx.h"
#include "support/inside_polygon.h"

using namespace contrejour;

namespace {

// The strokes with their middles in a square of 100 mm.
std::vector<DirtStroke> in_square(const Dirt& dirt) {
  std::vector<DirtStroke> inside;
  for (const DirtStroke& s : dirt_within(dirt, {-50.0, -50.0}, {50.0, 50.0}))
    if (std::max(std::abs(s.middle_mm.x), std::abs(s.middle_mm.y)) <= 50.0) inside.push_back(s);
  return inside;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <class Value>
std::vector<double> of_all(const std::vector<DirtStroke>& strokes, Value value) {
  std::vector<double> values;
  for (const DirtStroke& s : strokes) values.push_back(value(s));
  return values;
}

bool same(const DirtStroke& a, const DirtStroke& b) {
  return a.middle_mm == b.middle_mm && a.angle_rad == b.angle_rad && a.length_mm == b.length_mm &&
         a.width_mm == b.width_mm && a.bend_rad == b.bend_rad;
}

bool has(const std::vector<DirtStroke>& strokes, const DirtStroke& s) {
  return std::any_of(strokes.begin(), strokes.end(), [&](const DirtStroke& other) { return same(s, other); });
}

double area_of(const std::vector<Vec2>& polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) twice += cross(polygon[k], polygon[(k + 1) % polygon.size()]);
  return 0.5 * twice;
}

}  // namespace

TEST_CASE("dust has the density, the sizes and the even spread that were asked for, whatever the seed") {
  for (const std::uint32_t seed : {0U, 1U, 2U, 3U, 4000000000U}) {
    CAPTURE(seed);
    Dirt dirt;
    dirt.dust_per_cm2 = 50.0;
    dirt.dust_mm = 0.08;
    dirt.seed = seed;
    const auto dust = in_square(dirt);
    const double count = static_cast<double>(dust.size()), expected = 50.0 * 100.0;
    CHECK(std::abs(count - expected) < 4.0 * std::sqrt(expected));  // Poisson's deviation

    // Areas are those of discs whose diameters are log-normal.
    const auto diameter = [](const DirtStroke& s) {
      return std::sqrt(s.width_mm * s.width_mm + 4.0 / kPi * s.width_mm * s.length_mm);
    };
    CHECK(median(of_all(dust, diameter)) == test::approx(0.08).epsilon(0.03));
    double squares = 0.0;
    for (const double d : of_all(dust, diameter)) squares += std::pow(std::log(d / 0.08), 2.0);
    CHECK(std::sqrt(squares / count) == test::approx(Dirt::kSizeSpread).epsilon(0.05));

    // 100 squares of 10 mm: the variance of a Poisson count is its mean.
    std::vector<double> bins(100);
    for (const DirtStroke& s : dust)
      bins[static_cast<std::size_t>(std::min(9.0, std::floor((s.middle_mm.x + 50.0) / 10.0)) * 10.0 +
                                    std::min(9.0, std::floor((s.middle_mm.y + 50.0) / 10.0)))] += 1.0;
    double chi = 0.0;
    for (const double n : bins) chi += (n - 50.0) * (n - 50.0) / 50.0;
    CHECK(chi > 50.0);
    CHECK(chi < 160.0);
  }
}

TEST_CASE("scratches have the density, lengths, widths, directions and bends that were asked for") {
  Dirt dirt;
  dirt.scratches_per_cm2 = 20.0;
  dirt.scratch_length_mm = 6.0;
  dirt.scratch_width_mm = 0.02;
  dirt.scratch_angle_rad = 0.7;
  dirt.scratch_spread_rad = 0.3;
  dirt.scratch_bend_rad = 0.1;
  const auto scratches = in_square(dirt);
  const auto count = static_cast<double>(scratches.size());
  CHECK(std::abs(count - 2000.0) < 4.0 * std::sqrt(2000.0));
  CHECK(median(of_all(scratches, [](const DirtStroke& s) { return s.length_mm; })) == test::approx(6.0).epsilon(0.05));
  CHECK(median(of_all(scratches, [](const DirtStroke& s) { return s.width_mm; })) == test::approx(0.02).epsilon(0.05));
  double sum = 0.0, squares = 0.0, bends = 0.0;
  for (const DirtStroke& s : scratches) {
    CHECK(std::abs(s.angle_rad - 0.7) <= 0.3);
    CHECK(std::abs(s.bend_rad) <= 0.1);
    sum += s.angle_rad - 0.7;
    squares += std::pow(s.angle_rad - 0.7, 2.0);
    bends += s.bend_rad;
  }
  CHECK(std::abs(sum / count) < 0.02);
  CHECK(std::sqrt(squares / count) == test::approx(0.3 / std::sqrt(3.0)).epsilon(0.05));  // evenly spread
  CHECK(std::abs(bends / count) < 0.01);
}

TEST_CASE("a seed is its dirt: other seeds share nothing, points do not depend on the box, more adds to less") {
  Dirt dirt;
  dirt.dust_per_cm2 = 30.0;
  dirt.scratches_per_cm2 = 5.0;
  const auto whole = dirt_within(dirt, {-20.0, -20.0}, {20.0, 20.0});
  for (const DirtStroke& s : dirt_within(dirt, {-3.0, 2.0}, {5.0, 4.0})) CHECK(has(whole, s));
  for (const DirtStroke& s : whole)
    if (std::abs(s.middle_mm.x - 1.0) < 4.0 && std::abs(s.middle_mm.y - 3.0) < 1.0)
      CHECK(has(dirt_within(dirt, {-3.0, 2.0}, {5.0, 4.0}), s));

  Dirt more = dirt;
  more.dust_per_cm2 = 60.0;
  const auto twice = dirt_within(more, {-20.0, -20.0}, {20.0, 20.0});
  for (const DirtStroke& s : whole) CHECK(has(twice, s));

  Dirt other = dirt;
  other.seed = 1;
  for (const DirtStroke& s : dirt_within(other, {-20.0, -20.0}, {20.0, 20.0})) CHECK_FALSE(has(whole, s));
}

// The numbers themselves, so that a change of them on any platform is noticed.
TEST_CASE("the same seed gives the same dirt everywhere") {
  Dirt dirt;
  dirt.dust_per_cm2 = 10.0;
  dirt.seed = 7;
  const auto dust = dirt_within(dirt, {0.0, 0.0}, {10.0, 10.0});
  REQUIRE(dust.size() == 13);
  CHECK(dust[0].middle_mm.x == test::approx(4.49644170298056).epsilon(1e-13));
  CHECK(dust[0].middle_mm.y == test::approx(1.43719714874725).epsilon(1e-13));
  CHECK(dust[0].width_mm == test::approx(0.106727856441991).epsilon(1e-13));
  CHECK(dust[1].middle_mm.x == test::approx(9.06067403210429).epsilon(1e-13));
  CHECK(dust[1].angle_rad == test::approx(1.1783281195842).epsilon(1e-12));
}

TEST_CASE("dirt wanders smoothly and comes back after a turn") {
  Dirt dirt;
  dirt.dust_per_cm2 = 40.0;
  dirt.drift_mm = 0.5;
  const auto at = [&](double phase) {
    dirt.phase = phase;
    return dirt_within(dirt, {-200.0, -200.0}, {200.0, 200.0});  // so large that hardly any leave or enter
  };
  const auto still = at(0.0), back = at(3.0);
  REQUIRE(still.size() == back.size());
  for (std::size_t k = 0; k < still.size(); k += 97) CHECK(same(still[k], back[k]));
  // The fastest motion: 0.5 mm times 0.5 (1 + 2) 2 pi for each turn.
  const double fastest = 0.5 * 0.5 * 3.0 * 2.0 * kPi;
  constexpr double kFrame = 0.001;
  double farthest = 0.0;
  for (const double phase : {0.0, 0.25, 0.9995}) {
    const auto one = at(phase), next = at(phase + kFrame);
    for (std::size_t k = 0, other = 0; k < one.size() && other < next.size(); ++k, ++other) {
      while (other < next.size() && one[k].width_mm != next[other].width_mm) ++other;  // a new one
      if (other == next.size()) break;
      const Vec2 moved = next[other].middle_mm - one[k].middle_mm;
      CHECK(std::max(std::abs(moved.x), std::abs(moved.y)) <= fastest * kFrame);
      farthest = std::max(farthest, length(one[k].middle_mm - still[std::min(k, still.size() - 1)].middle_mm));
    }
  }
  CHECK(farthest > 0.2);  // some do move
}

TEST_CASE("a stroke's outline and its distance are those of points about its line") {
  std::mt19937 random(3);
  std::uniform_real_distribution<> any(0.0, 1.0);
  for (const double bend : {0.0, 1e-9, 0.3, -1.2, 3.0}) {
    for (const double length_mm : {0.0, 0.3, 2.0}) {
      CAPTURE(bend);
      CAPTURE(length_mm);
      const DirtStroke s{{0.3, -0.2}, 0.8, length_mm, 0.2, bend, 1.0};
      const auto outline = dirt_outline(s);
      CHECK(area_of(outline) == test::approx(length_mm * 0.2 + kPi * 0.01).epsilon(0.03));
      for (int i = 0; i < 200; ++i) {
        const Vec2 p = s.middle_mm + Vec2{3.0 * any(random) - 1.5, 3.0 * any(random) - 1.5};
        double nearest = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= 2000; ++k) nearest = std::min(nearest, length(p - s.at(k / 2000.0 - 0.5)));
        const double expected = nearest - 0.1;
        CHECK(s.distance_mm(p) == test::approx(expected).epsilon(1e-3));
        if (std::abs(expected) > 0.004) CHECK(test::inside_polygon(outline, p) == (expected < 0.0));
        CHECK((expected > 0.0 || length(p - s.middle_mm) <= s.outer_radius_mm()));
      }
    }
  }
}

TEST_CASE("a picture lies upright over the plane, clean beside it") {
  const std::vector<float> level{1.0F, 0.0F, 2.0F, 0.5F};  // top left, top right, bottom left, bottom right
  const auto picture = DirtPicture::from_levels(level, 2, 2).value();
  CHECK(picture->pixel() == 1.0);
  CHECK(picture->transmission({-0.5, 0.5}) == 1.0);
  CHECK(picture->transmission({0.5, 0.5}) == 0.0);
  CHECK(picture->transmission({-0.5, -0.5}) == 1.0);
  CHECK(picture->transmission({0.5, -0.5}) == 0.5);
  CHECK(picture->transmission({0.5, 0.0}) == test::approx(0.25));
  for (const Vec2 far : {Vec2{2.0, 0.0}, Vec2{0.0, -1e300}, Vec2{std::numeric_limits<double>::quiet_NaN(), 0.0}})
    CHECK(picture->transmission(far) == 1.0);
  CHECK_FALSE(DirtPicture::from_levels({}, 0, 0).has_value());
  CHECK_FALSE(DirtPicture::from_levels(std::vector<float>{-1.0F}, 1, 1).has_value());
  CHECK_FALSE(DirtPicture::from_levels(std::vector<float>{std::numeric_limits<float>::infinity()}, 1, 1).has_value());
}

TEST_CASE("dirt that cannot be is refused; none is none") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(check_dirt({}).has_value());
  CHECK(dirt_within({}, {-1e3, -1e3}, {1e3, 1e3}).empty());
  for (const double value : {nan, -1.0, 1e9, std::numeric_limits<double>::infinity()}) {
    CAPTURE(value);
    CHECK_FALSE(check_dirt({.dust_per_cm2 = value}).has_value());
    CHECK_FALSE(check_dirt({.dust_mm = value}).has_value());
    CHECK_FALSE(check_dirt({.scratches_per_cm2 = value}).has_value());
    CHECK_FALSE(check_dirt({.scratch_length_mm = value}).has_value());
    CHECK_FALSE(check_dirt({.scratch_width_mm = value}).has_value());
    CHECK_FALSE(check_dirt({.scratch_spread_rad = value}).has_value());
    CHECK_FALSE(check_dirt({.opacity = value}).has_value());
    CHECK_FALSE(check_dirt({.drift_mm = value}).has_value());
  }
  CHECK_FALSE(check_dirt({.phase = nan}).has_value());
  // All parameters at the ends of their ranges.
  Dirt largest{.dust_per_cm2 = Dirt::kMaxDustPerCm2, .dust_mm = 10.0, .scratches_per_cm2 = Dirt::kMaxScratchesPerCm2};
  largest.scratch_length_mm = Dirt::kLongest_mm;
  largest.scratch_width_mm = 10.0;
  largest.phase = -1e6;
  CHECK(check_dirt(largest).has_value());
  for (const DirtStroke& s : dirt_within(largest, {-1.0, -1.0}, {1.0, 1.0}))
    for (const Vec2 p : dirt_outline(s)) REQUIRE(std::isfinite(p.x + p.y));
}
