// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "measure/fit/halo.h"

using namespace contrejour;

namespace {

double halo_at(double r, int c) { return 1e5 * (c + 1) * std::exp(-r / 10.0); }

// A halo about the light and a ghost that moves the other way.
FitStation station_with_light_at(Vec2 light_px) {
  FitStation station;
  station.rate = station.weight = Image(120, 80);
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 120; ++x) {
      const double r = std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y);
      const bool in_ghost = std::hypot(x - (120.0 - light_px.x), y - 42.0) < 12.0;
      for (int c = 0; c < 3; ++c) {
        station.rate.at(x, y, c) = static_cast<float>(halo_at(r, c) + (in_ghost ? 50.0 : 0.0));
        station.weight.at(x, y, c) = 1.0F;
      }
    }
  }
  return station;
}

}  // namespace

TEST_CASE("halo: what moves with the light is subtracted, a ghost in it stays") {
  std::vector<FitStation> stations;
  std::vector<Vec2> lights;
  for (int k = 0; k < 7; ++k) {
    lights.push_back({30.3 + 10.0 * k, 37.8});
    stations.push_back(station_with_light_at(lights.back()));
  }
  const HaloProfile halo = halo_of(stations, lights, {6.0, 0.4});
  FitStation& first = stations.front();
  subtract_halo(first, halo, lights.front(), 6.0);
  CHECK(first.weight.at(30, 37, 1) == 0.0F);
  CHECK(first.weight.at(50, 37, 1) > 0.0F);
  CHECK(first.weight.at(40, 37, 1) < first.weight.at(110, 37, 1));  // the halo's error counts
  for (int c = 0; c < 3; ++c) {
    const double level = halo_at(std::hypot(90.5 - 30.3, 42.5 - 37.8), c);
    CHECK(static_cast<double>(first.rate.at(90, 42, c)) == doctest::Approx(50.0).epsilon(0.1 * level / 50.0));
  }
}
