// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "measure/fit/stations.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr int kRawWidth = 96, kRawHeight = 64;
constexpr double kRange = 50.0;  // brighter values are saturated

double steep_halo(int x, int y, Vec2 light_px) {
  return 4e4 * std::pow(std::hypot(x + 0.5 - light_px.x, y + 0.5 - light_px.y), -2.5);
}

CapturedImage saturated_halo(Vec2 light_px) {
  CapturedImage image{Image(kRawWidth, kRawHeight), Image(kRawWidth, kRawHeight), Image(kRawWidth, kRawHeight), {}};
  for (int y = 0; y < kRawHeight; ++y) {
    for (int x = 0; x < kRawWidth; ++x) {
      const double level = steep_halo(x, y, light_px);
      for (int c = 0; c < 3; ++c) {
        image.rate.at(x, y, c) = static_cast<float>(std::min(level, kRange));
        image.variance.at(x, y, c) = 1.0F;
        image.valid.at(x, y, c) = level < kRange ? 1.0F : 0.0F;
      }
    }
  }
  return image;
}

// The light that a pixel of a reduced picture would have without saturation.
double whole_block(int x, int y, int block, Vec2 light_px) {
  double sum = 0.0;
  for (int k = 0; k < block * block; ++k) sum += steep_halo(block * x + k % block, block * y + k / block, light_px);
  return sum;
}

double largest_error(const FitStation& station, int block, Vec2 light_px) {
  double most = 0.0;
  for (int y = 0; y < station.rate.height; ++y) {
    for (int x = 0; x < station.rate.width; ++x) {
      if (station.weight.at(x, y, 1) == 0.0F) continue;
      const double whole = whole_block(x, y, block, light_px);
      most = std::max(most, std::abs(static_cast<double>(station.rate.at(x, y, 1)) / whole - 1.0));
    }
  }
  return most;
}

// The least distance between two pixels that are sampled.
double least_distance(const StationFrame& frame) {
  double least = std::numeric_limits<double>::infinity();
  constexpr int kReach = 12;
  for (int y = 0; y <= kReach; ++y) {
    for (int x = -kReach; x <= kReach; ++x) {
      const bool later = y > 0 || x > 0;  // than the sampled pixel (sampled_every, 0)
      if (later && frame.is_sampled(frame.sampled_every + x, y)) least = std::min(least, std::hypot(x, y));
    }
  }
  return least;
}

}  // namespace

TEST_CASE("stations: reduced pictures have the light of whole blocks, also beside saturated pixels") {
  const Vec2 light{40.3, 30.7};
  FlareSweep sweep;
  for (int k = -2; k <= 2; ++k) sweep.angles_rad.push_back(0.05 * k);
  sweep.picture = [&](std::size_t) -> Result<CapturedImage> { return saturated_halo(light); };
  FlareFitOptions options;
  options.max_width = kRawWidth / 2;
  const SweepGeometry geometry{{48.0, 32.0}, 100.0, 0.0, 0.0, 0.0, 0.0, {}};
  const Result<SweepStations> reduced = reduced_stations(sweep, geometry, options, {});
  REQUIRE(reduced);
  const FitStation& station = reduced->stations.front();
  REQUIRE(station.rate.width == kRawWidth / 2);
  CHECK(reduced->saturated > 0.0);
  CHECK(largest_error(station, 2, light) < 1e-5);
  CHECK(largest_error(half_size_station(station), 4, light) < 1e-5);
  // Blocks with saturated pixels have what they have at least.
  CHECK(station.weight.at(20, 15, 1) == 0.0F);
  CHECK(static_cast<double>(station.rate.at(20, 15, 1)) == test::approx(4.0 * kRange));
}

TEST_CASE("stations: saturated pixels of a mosaic give the least value of those interpolated from them") {
  FlareSweep sweep;
  for (int k = -2; k <= 2; ++k) sweep.angles_rad.push_back(0.05 * k);
  sweep.picture = [](std::size_t) -> Result<CapturedImage> {
    CapturedImage image{Image(8, 6), Image(8, 6), Image(8, 6, 1), {}, BayerPattern::Rggb};
    for (float& v : image.rate.pixels) v = 8.0F;
    for (float& v : image.variance.pixels) v = 1.0F;
    for (float& v : image.valid.pixels) v = 1.0F;
    for (int c = 0; c < 3; ++c) image.rate.at(4, 3, c) = 40.0F;
    image.valid.at(4, 3, 0) = 0.0F;
    return image;
  };
  const SweepGeometry geometry{{4.0, 3.0}, 10.0, 0.0, 0.0, 0.0, 0.0, {}};
  const Result<SweepStations> reduced = reduced_stations(sweep, geometry, {}, {});
  REQUIRE(reduced);
  const FitStation& station = reduced->stations.front();
  CHECK(station.weight.at(4, 3, 1) == 0.0F);
  CHECK(station.rate.at(4, 3, 1) == 40.0F);
  CHECK(station.weight.at(4, 3, 0) == 0.0F);  // three quarters of its own value on each axis, one of its neighbour's
  CHECK(station.rate.at(4, 3, 0) == test::approx(8.0 + 32.0 * 0.75 * 0.75));
  CHECK(station.weight.at(5, 4, 0) + station.weight.at(3, 2, 0) + station.weight.at(5, 2, 0) > 0.0F);
}

TEST_CASE("stations: samples are evenly spread, however few they are") {
  FitStation station;
  station.rate = station.weight = Image(60, 40);
  station.frame.pixels = {60, 40, 50.0, {30.0, 20.0}};
  for (float& weight : station.weight.pixels) weight = 1.0F;
  for (const int every : {2, 3, 4, 6, 8, 12, 16, 24}) {
    CAPTURE(every);
    const FitStation sampled = sampled_stations({station}, every).front();
    CHECK(least_distance(sampled.frame) > 0.7 * std::sqrt(every));
    const auto used = std::ranges::count_if(sampled.weight.pixels, [](float weight) { return weight > 0.0F; });
    CHECK(static_cast<double>(used) == test::approx(3.0 * 60.0 * 40.0 / every).epsilon(0.03));
  }
}

TEST_CASE(
    "stations: a channel that is not measured is guessed from the others and its least value, with twice the error") {
  FitStation station;
  station.rate = station.weight = Image(3, 1);
  const auto set = [&](int x, int channel, float rate, float weight) {
    station.rate.at(x, 0, channel) = rate;
    station.weight.at(x, 0, channel) = weight;
  };
  set(0, 0, 2.0F, 4.0F);  // blue saturates
  set(0, 1, 4.0F, 4.0F);
  set(1, 1, 5.0F, 1.0F);  // all channels, or none, at the others
  set(1, 0, 6.0F, 1.0F);
  set(1, 2, 7.0F, 1.0F);
  const FitStation before = station;
  guess_channels(station);
  CHECK(station.rate.at(0, 0, 2) == test::approx(3.0));
  CHECK(station.weight.at(0, 0, 2) == test::approx(1.0 / (6.0 * 6.0 + 0.25)));
  station.weight.at(0, 0, 2) = 0.0F;
  station.rate.at(0, 0, 2) = 5.0F;  // what saturates is at least that bright
  guess_channels(station);
  CHECK(station.rate.at(0, 0, 2) == 5.0F);
  CHECK(station.weight.at(0, 0, 2) == test::approx(1.0 / (10.0 * 10.0 + 0.25)));
  station.rate.at(0, 0, 2) = station.weight.at(0, 0, 2) = 0.0F;
  CHECK(station.rate.pixels == before.rate.pixels);
  CHECK(station.weight.pixels == before.weight.pixels);
}
