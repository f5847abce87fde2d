// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <doctest/doctest.h>

#include "measure/fit/halo.h"

using namespace contrejour;

TEST_CASE("halo: what surrounds the light is subtracted, a ghost in it stays") {
  FitStation station;
  station.rate = station.weight = Image(120, 80);
  const Vec2 light_px{40.3, 37.8};
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 120; ++x) {
      const double r = std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y);
      const bool in_ghost = std::hypot(x - 85.0, y - 42.0) < 12.0;
      for (int c = 0; c < 3; ++c) {
        station.rate.at(x, y, c) = static_cast<float>(1e5 * (c + 1) / (1.0 + 0.1 * r * r) + (in_ghost ? 50.0 : 0.0));
        station.weight.at(x, y, c) = 1.0F;
      }
    }
  }
  subtract_halo(station, light_px, 6.0);
  CHECK(station.weight.at(40, 37, 1) == 0.0F);
  CHECK(station.weight.at(60, 37, 1) > 0.0F);
  CHECK(station.weight.at(50, 37, 1) < station.weight.at(110, 37, 1));  // the halo's error counts
  for (int c = 0; c < 3; ++c) {
    const double halo = 1e5 * (c + 1) / (1.0 + 0.1 * 44.0 * 44.0);
    CHECK(static_cast<double>(station.rate.at(85, 42, c)) == doctest::Approx(50.0).epsilon(0.06 * halo / 50.0));
    CHECK(std::abs(static_cast<double>(station.rate.at(40, 75, c))) < 0.1 * 1e5 * (c + 1) / (1.0 + 0.1 * 37.0 * 37.0));
  }
}
