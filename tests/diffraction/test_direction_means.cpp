// SPDX-License-Identifier: Apache-2.0
// Means over windows of directions: of a constant, of a step, of a wave, across the end of the half turn.
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "diffraction/direction_means.h"
#include "support/approx.h"

using namespace contrejour;

namespace {}  // namespace

TEST_CASE("means over windows of directions go on beyond half a turn") {
  constexpr int kParts = 90;
  std::vector<double> values;
  for (int i = 0; i < kParts; ++i) values.push_back(2.0 + std::cos(2.0 * (i + 0.5) * kPi / kParts));
  const DirectionMeans means(values);
  for (const double window : {0.5, 1.0, kPi, 1.3 * kPi}) {
    CAPTURE(window);
    for (double angle = -7.0; angle < 7.0; angle += 0.173)  // of cos(2 a): sinc of the window
      CHECK(std::abs(means.over(angle, window) - 2.0 - std::cos(2.0 * angle) * std::sin(window) / window) < 1e-3);
  }
  for (double angle = -7.0; angle < 7.0; angle += 0.1)
    CHECK(means.over(angle + kPi, 0.2) == test::approx(means.over(angle, 0.2)));
}

TEST_CASE("windows narrower than a part go from value to value by straight lines") {
  const DirectionMeans means(std::vector<double>{1.0, 5.0});
  CHECK(means.over(0.25 * kPi, 0.0) == test::approx(1.0));
  CHECK(means.over(0.75 * kPi, 1e-9) == test::approx(5.0));
  CHECK(means.over(0.375 * kPi, 0.0) == test::approx(2.0));
  CHECK(means.over(kPi, 0.1) == test::approx(3.0));  // between the last and the first
  CHECK(means.over(0.25 * kPi, kPi) == test::approx(3.0));
  CHECK(DirectionMeans().over(1.0, 1.0) == 0.0);
}
