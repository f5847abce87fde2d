// SPDX-License-Identifier: Apache-2.0
// The terms of a profile: their values add to 1 on every ring, are continuous, and have the derivatives stated.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/expert/ghost_profile.h"
#include "measure/random_ghosts.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

// A profile with these levels at a point.
double level_at(const GhostOutline& outline, Vec2 point, const std::array<double, kProfileTerms>& levels) {
  const ProfileWeights weights = profile_weights(outline, point);
  double level = 0.0;
  for (std::size_t k = 0; k < weights.term.size(); ++k) level += weights.value[k] * levels[weights.term[k]];
  return level;
}

}  // namespace

TEST_CASE("ghost profile: terms are numbered by harmonic and ring") {
  for (std::size_t k = 0; k < kProfileTerms; ++k) CHECK(profile_index(profile_term(k)) == k);
  double area = 0.0;
  for (std::size_t k = 0; k < kProfileTerms; ++k) area += profile_mean(k);
  CHECK(area == test::approx(1.0));
  CHECK(profile_term(kProfileTerms - 1).harmonic == kProfileHarmonics - 1);
}

TEST_CASE("ghost profile: a constant is one, the centre has no direction, and the last ring reaches outwards") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::array<double, kProfileTerms> constant{}, sided{};
  for (std::size_t k = 0; k < kProfileTerms; ++k) {
    if (profile_term(k).harmonic == 0) constant[k] = 3.0;
    if (profile_term(k).harmonic == 1) sided[k] = 1.0;
  }
  for (int k = 0; k < 50; ++k) {
    const GhostOutline outline = test::random_outline(random);
    const Vec2 point{outline.centre + 0.3 * unit(random), 0.3 * unit(random)};
    CHECK(level_at(outline, point, constant) == test::approx(3.0));
    CHECK(level_at(outline, {outline.centre, 0.0}, sided) == 0.0);
    CHECK(level_at(outline, {outline.centre + outline.right, 0.0}, sided) == test::approx(1.0));
    CHECK(level_at(outline, {outline.centre - 2.0 * outline.left, 0.0}, sided) == test::approx(-1.0));
    CHECK(level_at(outline, {point.x, -point.y}, sided) == test::approx(level_at(outline, point, sided)));
  }
}

TEST_CASE("ghost profile: derivatives by the place agree with central differences to 1e-5") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const GhostOutline outline{0.0, 1.0, 1.0, 1.0};
  std::array<double, kProfileTerms> levels{};
  for (double& level : levels) level = unit(random);
  const auto level_of = [&](double x, double y) { return level_at(outline, {x, y}, levels); };
  int checked = 0;
  for (int k = 0; k < 200; ++k) {
    const double x = unit(random), y = unit(random), h = 1e-6;
    const double ring = std::hypot(x, y) * (kProfileRings - 1);
    if (std::abs(ring - std::round(ring)) < 1e-3) continue;  // levels have a kink there
    const ProfileWeights weights = profile_weights(outline, {x, y});
    Vec2 slope{};
    for (std::size_t i = 0; i < weights.term.size(); ++i) slope = slope + weights.by_place[i] * levels[weights.term[i]];
    CHECK(slope.x == test::approx((level_of(x + h, y) - level_of(x - h, y)) / (2.0 * h)).epsilon(1e-5));
    CHECK(slope.y == test::approx((level_of(x, y + h) - level_of(x, y - h)) / (2.0 * h)).epsilon(1e-5));
    ++checked;
  }
  CHECK(checked > 100);
}
