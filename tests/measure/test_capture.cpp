// SPDX-License-Identifier: Apache-2.0
// Known pictures exposed by the simulated sensor and merged again.
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "contrejour/expert/capture.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr double kTimes_s[] = {0.25, 1.0, 4.0};  // walch2018, 3.1

// Smooth rates from a few DN per second to 40000, even within blocks of 2 x 2.
Image known_rates(int width = 128, int height = 96) {
  Image rate(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double level = 2.0 * std::pow(10.0, 4.3 * (x / 2) / (width / 2.0));
      for (int c = 0; c < 3; ++c) rate.at(x, y, c) = static_cast<float>(level * (1.0 + 0.3 * c));
    }
  }
  return rate;
}

std::vector<RawFrame> exposed(const Image& rate, const SensorModel& sensor = {}, std::uint64_t seed = 1) {
  std::vector<RawFrame> frames;
  for (const double time_s : kTimes_s) frames.push_back(*expose(rate, sensor, time_s, ++seed));
  return frames;
}

struct Agreement {
  double mean_error = 0, chi_squared = 0, valid = 0;  // mean_error: in standard deviations of the mean
};

// What is valid against the truth.
Agreement agreement(const CapturedImage& merged, const Image& rate) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (int y = 0; y < merged.rate.height; ++y) {
    for (int x = 0; x < merged.rate.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        if (merged.valid.at(x, y, c) == 0.0F) continue;
        const double off = static_cast<double>(merged.rate.at(x, y, c)) - static_cast<double>(rate.at(2 * x, 2 * y, c));
        const double deviation = std::sqrt(static_cast<double>(merged.variance.at(x, y, c)));
        sum += off / deviation;
        squares += off * off / (deviation * deviation);
        ++count;
      }
    }
  }
  return {sum / std::sqrt(count), squares / count, count / static_cast<double>(merged.valid.pixels.size())};
}

}  // namespace

TEST_CASE("capture: exposures have the noise of photons and of reading") {
  Image rate(200, 200);
  std::fill(rate.pixels.begin(), rate.pixels.end(), 100.0F);
  for (const double time_s : {0.2, 10.0}) {  // 10 and 500 electrons
    const SensorModel sensor;
    const auto frame = expose(rate, sensor, time_s, 5);
    REQUIRE(frame.has_value());
    const double count = static_cast<double>(frame->dn.size());
    const double mean = std::accumulate(frame->dn.begin(), frame->dn.end(), 0.0) / count;
    double variance = 0.0;
    for (const std::uint16_t dn : frame->dn) variance += (dn - mean) * (dn - mean) / count;
    CHECK(mean - sensor.black_dn == test::approx(100.0 * time_s).epsilon(0.01));
    const double electrons = 100.0 * time_s * 0.5;
    CHECK(variance == test::approx((electrons + 9.0) / 0.25 + 1.0 / 12.0).epsilon(0.03));
  }
}

TEST_CASE("capture: merged rates are right within their variance, for every Bayer pattern") {
  const Image rate = known_rates();
  for (const BayerPattern pattern : {BayerPattern::Rggb, BayerPattern::Bggr, BayerPattern::Grbg, BayerPattern::Gbrg}) {
    SensorModel sensor;
    sensor.pattern = pattern;
    const auto merged = merge_exposures(exposed(rate, sensor), {});
    REQUIRE(merged.has_value());
    CHECK(merged->warnings.empty());
    CHECK(merged->rate.width == 64);
    const Agreement found = agreement(*merged, rate);
    CHECK(std::abs(found.mean_error) < 4.0);
    CHECK(found.chi_squared == test::approx(1.0).epsilon(0.05));
    CHECK(found.valid > 0.9);
  }
}

TEST_CASE("capture: what every exposure saturates is marked, with its neighbours") {
  Image rate = known_rates();
  for (int y = 40; y < 44; ++y) {
    for (int x = 20; x < 24; ++x) {
      for (int c = 0; c < 3; ++c) rate.at(x, y, c) = 1e6F;
    }
  }
  const auto merged = merge_exposures(exposed(rate), {});
  REQUIRE(merged.has_value());
  CHECK(merged->valid.at(10, 20, 1) == 0.0F);
  CHECK(merged->valid.at(9, 19, 0) == 0.0F);
  CHECK(merged->valid.at(12, 22, 2) == 0.0F);
  CHECK(merged->valid.at(8, 20, 1) == 1.0F);
  CHECK(merged->rate.at(10, 20, 1) > 5e4F);
}

TEST_CASE("capture: a room that is not quite dark is subtracted") {
  const Image rate = known_rates();
  Image lit = rate, room(rate.width, rate.height);
  for (std::size_t k = 0; k < lit.pixels.size(); ++k) {
    room.pixels[k] = 40.0F + static_cast<float>(k % 7);
    lit.pixels[k] += room.pixels[k];
  }
  std::vector<RawFrame> background;
  for (std::uint64_t repeat = 0; repeat < 30; ++repeat) {
    for (const RawFrame& frame : exposed(room, {}, 100 + 10 * repeat)) background.push_back(frame);
  }
  const auto merged = merge_exposures(exposed(lit), background);
  REQUIRE(merged.has_value());
  const Agreement found = agreement(*merged, rate);
  CHECK(found.chi_squared == test::approx(1.0).epsilon(0.1));
  CHECK(std::abs(found.mean_error) < 4.0);
  CHECK(agreement(*merge_exposures(exposed(lit), {}), rate).chi_squared > 20.0);
}

TEST_CASE("capture: an exposure with a cloud before the lamp is recognised and left out") {
  const Image rate = known_rates();
  Image dimmed = rate;
  for (float& value : dimmed.pixels) value *= 0.8F;
  for (std::size_t cloudy = 0; cloudy < 3; ++cloudy) {
    std::vector<RawFrame> frames = exposed(rate);
    frames[cloudy] = *expose(dimmed, {}, kTimes_s[cloudy], 77);
    const auto merged = merge_exposures(frames, {});
    REQUIRE(merged.has_value());
    REQUIRE(merged->warnings.size() == 1);
    CHECK(merged->warnings[0].find("left out") != std::string::npos);
    CHECK(agreement(*merged, rate).chi_squared == test::approx(1.0).epsilon(0.1));
  }
}

TEST_CASE("capture: a drifting lamp is divided out by the monitor patch") {
  Image rate = known_rates();
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      for (int c = 0; c < 3; ++c) rate.at(x, y, c) = 2000.0F;
    }
  }
  std::vector<RawFrame> frames;
  for (std::size_t k = 0; k < 3; ++k) {
    Image drifted = rate;
    for (float& value : drifted.pixels) value *= 1.0F + 0.1F * static_cast<float>(k);
    frames.push_back(*expose(drifted, {}, kTimes_s[k], 10 + k));
  }
  MergeSettings settings;
  settings.monitor = MonitorPatch{2, 2, 12, 12, 2000.0};
  const auto merged = merge_exposures(frames, {}, settings);
  REQUIRE(merged.has_value());
  CHECK(merged->warnings.empty());
  CHECK(agreement(*merged, rate).chi_squared < 1.6);
  MergeSettings any_level;
  any_level.max_disagreement = 1.0;
  CHECK(agreement(*merge_exposures(frames, {}, any_level), rate).chi_squared > 10.0);
}

TEST_CASE("capture: the same bits for any number of threads") {
  const Image rate = known_rates();
  const auto one = expose(rate, {}, 1.0, 3, {.threads = 1}), four = expose(rate, {}, 1.0, 3, {.threads = 4});
  CHECK(one->dn == four->dn);
  const auto a = merge_exposures(exposed(rate), {}, {}, {.threads = 1});
  const auto b = merge_exposures(exposed(rate), {}, {}, {.threads = 4});
  CHECK(a->rate.pixels == b->rate.pixels);
}

TEST_CASE("capture: frames that cannot be merged are refused") {
  const std::vector<RawFrame> frames = exposed(known_rates());
  CHECK(!merge_exposures({}, {}));
  std::vector<RawFrame> mixed = frames;
  mixed[1].pattern = BayerPattern::Bggr;
  CHECK(!merge_exposures(mixed, {}));
  mixed = frames;
  mixed[2].dn.pop_back();
  CHECK(!merge_exposures(mixed, {}));
  mixed = frames;
  mixed[0].time_s = 0.0;
  CHECK(!merge_exposures(mixed, {}));
  MergeSettings outside;
  outside.monitor = MonitorPatch{120, 90, 20, 20, 100.0};
  CHECK(!merge_exposures(frames, {}, outside));
  CHECK(!expose(Image(3, 3), {}, 1.0, 1));
  CHECK(!expose(known_rates(), {}, 0.0, 1));
}
