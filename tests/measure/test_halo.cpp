// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "measure/fit/halo.h"
#include "support/approx.h"

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

// Nine stations across the axis, which change(station, x, y, offset from the light) makes differ at each pixel.
struct HaloSweep {
  std::vector<FitStation> stations;
  std::vector<Vec2> lights;
};

template <class Change>
HaloSweep sweep_across(const Change& change) {
  HaloSweep sweep;
  for (int k = 0; k < 9; ++k) {
    const Vec2 light{20.3 + 10.0 * k, 37.8};
    FitStation station = station_with_light_at(light);
    station.s = std::abs(0.1 * (k - 4));
    station.frame.to_light = {k < 4 ? -0.8 : 0.8, 0.6};  // y up
    for (int y = 0; y < station.rate.height; ++y)
      for (int x = 0; x < station.rate.width; ++x) change(station, x, y, Vec2{x + 0.5, y + 0.5} - light);
    sweep.lights.push_back(light);
    sweep.stations.push_back(std::move(station));
  }
  return sweep;
}

void multiply(FitStation& station, int x, int y, double factor) {
  for (int c = 0; c < 3; ++c) station.rate.at(x, y, c) *= static_cast<float>(factor);
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
    CHECK(static_cast<double>(first.rate.at(90, 42, c)) == test::approx(50.0).epsilon(0.1 * level / 50.0));
  }
}

TEST_CASE("halo: its level changes with the angle, and by a little from station to station") {
  const auto level_of = [](double s, double deviation) { return (1.0 - 2.0 * s * s) * deviation; };
  auto [stations, lights] =
      sweep_across([&](FitStation& of, int x, int y, Vec2 /*offset*/) { multiply(of, x, y, level_of(of.s, 1.0)); });
  for (float& v : stations[2].rate.pixels) v *= 1.02F;
  const HaloProfile halo = halo_of(stations, lights, {6.0, 0.5});
  CHECK(halo.scale(0.0) == 1.0);
  for (const double s : {0.2, 0.4}) CHECK(halo.scale(s) == test::approx(level_of(s, 1.0)).epsilon(0.01));
  CHECK(halo_deviation(halo, stations[2], lights[2], 6.0) == test::approx(1.02).epsilon(0.005));
  CHECK(halo_deviation(halo, stations[5], lights[5], 6.0) == test::approx(1.0).epsilon(0.005));
  // What is left at the largest angle is far less than a profile that were the same everywhere would leave.
  FitStation last = stations.back();
  subtract_halo(last, halo, lights.back(), 6.0, halo_deviation(halo, last, lights.back(), 6.0));
  const double r = std::hypot(110.5 - lights.back().x, 37.5 - lights.back().y);
  CHECK(std::abs(static_cast<double>(last.rate.at(110, 37, 1))) < 0.05 * halo_at(r, 1) * level_of(0.4, 1.0));
}

// A light so bright that every exposure saturates out to 25 pixels, which is more than four times the mask's radius.
TEST_CASE("halo: beside a large saturated middle, its level is known as well, and nothing nearer is fitted") {
  constexpr double kSaturated_px = 25.0;
  auto [stations, lights] = sweep_across([&](FitStation& of, int x, int y, Vec2 offset) {
    for (int c = 0; c < 3 && length(offset) < kSaturated_px; ++c) of.weight.at(x, y, c) = 0.0F;
  });
  for (float& v : stations[2].rate.pixels) v *= 1.02F;
  const HaloProfile halo = halo_of(stations, lights, {6.0, 0.5});
  CHECK(halo_deviation(halo, stations[2], lights[2], 6.0) == test::approx(1.02).epsilon(0.005));
  FitStation& middle = stations[4];
  subtract_halo(middle, halo, lights[4], 6.0);
  for (int x = 60; x < 90; ++x) {
    const double r = std::hypot(x + 0.5 - lights[4].x, 40.5 - lights[4].y);
    if (middle.weight.at(x, 40, 1) == 0.0F) continue;
    CAPTURE(r);
    CHECK(std::abs(static_cast<double>(middle.rate.at(x, 40, 1))) < 0.01 * halo_at(r, 1));
  }
  CHECK(middle.weight.at(83, 40, 1) == 0.0F);
  CHECK(middle.weight.at(90, 40, 1) > 0.0F);
}

TEST_CASE("halo: a pupil that vignetting makes oblong") {
  constexpr double kOblong = 0.5;
  auto [stations, lights] = sweep_across([&](FitStation& of, int x, int y, Vec2 offset) {
    const Vec2 away{of.frame.to_light.x, -of.frame.to_light.y};
    const double phi = std::atan2(offset.y, offset.x) - std::atan2(away.y, away.x);
    multiply(of, x, y, 1.0 + kOblong * of.s * of.s * std::cos(2.0 * phi));
  });
  const HaloProfile halo = halo_of(stations, lights, {6.0, 0.5});
  CHECK(halo.oblong == test::approx(kOblong).epsilon(0.05));
  FitStation last = stations.back();
  subtract_halo(last, halo, lights.back(), 6.0);
  for (const Vec2 at : {Vec2{112.0, 38.0}, Vec2{88.0, 38.0}, Vec2{100.0, 50.0}, Vec2{92.0, 30.0}}) {
    const double left = last.rate.at(static_cast<int>(at.x), static_cast<int>(at.y), 1);
    CHECK(std::abs(left) < 0.01 * halo_at(length(at + Vec2{0.5, 0.5} - lights.back()), 1));
  }
}
