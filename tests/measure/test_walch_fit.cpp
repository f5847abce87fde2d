// SPDX-License-Identifier: Apache-2.0
// The paper's coordinate descent, as a baseline: what it costs and where it goes, on a ghost of its own model.
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "measure/fit/walch_fit.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

MeasuredFlare walch_disc(double radius) {
  MeasuredFlare flare{"disc", "", 0.4, std::nullopt, {{}}};
  MeasuredGhost& ghost = flare.ghosts[0];
  ghost.centre.coefficients = {-0.8};
  ghost.half_width.coefficients = ghost.half_height.coefficients = {radius};
  ghost.width_in.coefficients = ghost.width_out.coefficients = {0.01};
  for (std::size_t c = 0; c < 3; ++c) ghost.border[c].coefficients = ghost.inside[c].coefficients = {1e4};
  ghost.last = 0.4;
  return flare;
}

std::vector<FitStation> walch_stations(const MeasuredFlare& flare) {
  std::vector<FitStation> stations;
  for (int k = 0; k < 4; ++k) {
    FitStation station;
    station.s = 0.14 + 0.04 * k;
    station.frame = {{64, 44, 60.0, {41.3, 22.8}}, {1.0, 0.0}};
    station.rate = Image(64, 44);
    station.weight = Image(64, 44);
    for (float& w : station.weight.pixels) w = 1.0F;
    station.rate = model_image(flare, station);
    stations.push_back(std::move(station));
  }
  return stations;
}

}  // namespace

TEST_CASE("walch fit: the cost is 0 for the right model and rises with the error") {
  const auto stations = walch_stations(walch_disc(0.12));
  const Image picture = grey_picture(stations[0]);
  double last = -1e-12;
  for (const double radius : {0.12, 0.125, 0.14, 0.18}) {
    auto ghost = *ghost_at(walch_disc(radius).ghosts[0], stations[0].s, 0.4);
    ghost.border[0] *= 3.0;
    ghost.inside[0] *= 3.0;
    const double cost = walch_cost(picture, grey_model(std::span(&ghost, 1), stations[0]), {});
    CHECK(cost > last);
    last = cost;
  }
}

TEST_CASE("walch fit: follows a disc from station to station, with two evaluations for each parameter and iteration") {
  const auto stations = walch_stations(walch_disc(0.12));
  WalchSettings settings;
  settings.iterations = 12;
  const WalchFit fit = walch_fit(stations, walch_disc(0.126), settings, {});
  CHECK(fit.image_evaluations == 4.0 * (1.0 + 12.0 * 24.0));
  CHECK(fit.progress.back().cost < 0.01);
  CHECK(fit.progress.size() == 48);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    REQUIRE(fit.ghosts[k].size() == 1);
    CHECK(fit.ghosts[k][0].outline.half_height == test::approx(0.12).epsilon(0.05));
    CHECK(fit.ghosts[k][0].outline.centre == test::approx(-0.8 * stations[k].s).epsilon(0.025).scale(1.0));
  }
}
