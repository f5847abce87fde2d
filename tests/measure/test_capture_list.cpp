// SPDX-License-Identifier: Apache-2.0
// The list of a sweep's photographs, the light's own image in a short exposure, stations merged from callbacks.
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/merge_stations.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

CapturePlan small_plan() {
  CapturePlan plan;
  plan.stations = 5;
  plan.to_deg = 20.0;
  plan.background_every = 3;
  plan.times_s = {0.5, 2.0};
  return plan;
}

// A disc of a light about a point of the raw picture, over a background.
RawFrame light_frame(Vec2 centre, double radius, double rate, double time_s) {
  Image image(80, 60);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double inside = std::clamp(radius + 0.5 - length(Vec2{x + 0.5, y + 0.5} - centre), 0.0, 1.0);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(rate * (c + 1) * inside + 50.0);
    }
  }
  SensorModel sensor;
  sensor.noise.read_electrons = 1.0;
  return *expose(image, sensor, time_s, 7);
}

RawFrame even_frame(double rate, double time_s) {
  Image image(16, 12);
  std::fill(image.pixels.begin(), image.pixels.end(), static_cast<float>(rate));
  return *expose(image, {}, time_s, 3);
}

}  // namespace

TEST_CASE("capture list: a plan has every station, background and short exposure once") {
  const auto captures = plan_captures(small_plan());
  REQUIRE(captures.has_value());
  const auto count = [&](CaptureKind kind) { return std::ranges::count(*captures, kind, &PlannedCapture::kind); };
  CHECK(count(CaptureKind::Exposure) == 10);
  CHECK(count(CaptureKind::Direct) == 5);
  CHECK(count(CaptureKind::Background) == 6);  // at stations 1, 4 and 5
  CHECK(captures->front().angle_deg == -20.0);
  CHECK(captures->back().angle_deg == 20.0);
  CapturePlan wrong = small_plan();
  wrong.times_s = {0.0};
  CHECK(!plan_captures(wrong));
  wrong = small_plan();
  wrong.stations = 0;
  CHECK(!plan_captures(wrong));
}

TEST_CASE("capture list: what is written reads back") {
  const auto captures = *plan_captures(small_plan());
  const std::string csv = write_captures(captures);
  const auto again = read_captures("# a comment\n\n" + csv, "a.csv");
  REQUIRE(again.has_value());
  CHECK(write_captures(*again) == csv);
  CHECK((*again)[3].file == captures[3].file);
  const auto comma = read_captures("station,angle_deg,kind,time_s,file\r\n3, -1.5 ,direct,0.001,a, b.dng\r\n", "a.csv");
  REQUIRE(comma.has_value());
  CHECK(comma->front().file == "a, b.dng");
  CHECK(comma->front().kind == CaptureKind::Direct);
}

TEST_CASE("capture list: errors name file and line") {
  const auto error = [](const std::string& line) {
    const auto read = read_captures("station,angle_deg,kind,time_s,file\n" + line, "a.csv");
    return read ? std::string("accepted") : read.error().to_string();
  };
  for (const char* line : {"1,0,exposure,1", "0,0,exposure,1,f", "1,nan,exposure,1,f", "1,0,dark,1,f", "1,0,direct,0,f",
                           "1,0,direct,inf,f", "1x,0,direct,1,f", "1,0,exposure,1,"}) {
    CHECK(error(line).find("a.csv:2:") == 0);
  }
  CHECK(error("").find("no photographs") != std::string::npos);
  CHECK(read_captures("a,b\n", "a.csv").error().to_string().find("a.csv:1:") == 0);
}

TEST_CASE("capture list: a station takes the nearest background") {
  const auto stations = stations_of(*plan_captures(small_plan()));
  REQUIRE(stations.has_value());
  REQUIRE(stations->size() == 5);
  CHECK((*stations)[0].background.front().station == 1);
  CHECK((*stations)[1].background.front().station == 1);
  CHECK((*stations)[2].background.front().station == 4);
  CHECK((*stations)[3].exposures.size() == 2);
  const std::vector<PlannedCapture> two{{1, 0.0, CaptureKind::Exposure, 1.0, "a"},
                                        {1, 1.0, CaptureKind::Exposure, 2.0, "b"}};
  CHECK(!stations_of(two));
  const std::vector<PlannedCapture> none{{1, 0.0, CaptureKind::Direct, 1.0, "a"}};
  CHECK(!stations_of(none));
}

TEST_CASE("capture list: the light's flux, wherever its image lies and whatever its size") {
  for (const double radius : {3.0, 6.0}) {
    for (const Vec2 centre : {Vec2{40.0, 30.0}, Vec2{31.3, 34.6}}) {
      const auto flux = direct_flux(light_frame(centre, radius, 1e6, 0.004));
      REQUIRE(flux.has_value());
      CHECK(length(flux->position_px - centre * 0.5) < 0.15);
      const double area = std::numbers::pi * radius * radius / 4.0;  // of merged pixels
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(flux->rate[c] == test::approx(1e6 * static_cast<double>(c + 1) * area).epsilon(0.05));
    }
  }
  CHECK(!direct_flux(light_frame({40.0, 30.0}, 3.0, 1e9, 0.004)));  // saturated
  CHECK(!direct_flux(light_frame({400.0, 30.0}, 3.0, 1e6, 0.004)));  // not in the picture
}

TEST_CASE("capture list: a lamp that flickers is found, one that drifts is not") {
  std::vector<double> flux;
  for (int k = 0; k < 20; ++k) flux.push_back(100.0 + 2.0 * k);
  CHECK(unsteady_stations(flux, 0.1).empty());
  flux[7] *= 0.8;
  CHECK(unsteady_stations(flux, 0.1) == std::vector<std::size_t>{7});
  CHECK(unsteady_stations({}, 0.1).empty());
}

TEST_CASE("capture list: stations merge alike for any number at once; a broken one is left out") {
  const auto stations = *stations_of(*plan_captures(small_plan()));
  const auto run = [&](int at_once) {
    std::map<int, float> written;
    std::mutex mutex;
    const auto outcomes = merge_stations(
        stations,
        [](const PlannedCapture& c) -> Result<RawFrame> {
          if (c.station == 2) return failure(ErrorCode::Io, "broken", {c.file, 0, 0});
          if (c.kind == CaptureKind::Direct) return even_frame(0.0, c.time_s);
          return even_frame(c.kind == CaptureKind::Exposure ? 100.0 * c.station + 20.0 : 20.0, c.time_s);
        },
        [&](const MergedStation& merged) -> Result<void> {
          const std::scoped_lock lock(mutex);
          written[merged.station] = merged.image.rate.at(3, 2, 1);
          return {};
        },
        {}, at_once);
    REQUIRE(outcomes.has_value());
    CHECK((*outcomes)[1].error.has_value());
    CHECK(!(*outcomes)[0].error.has_value());
    CHECK(!(*outcomes)[0].warnings.empty());  // no light in the short exposure
    return written;
  };
  const auto one = run(1), three = run(3);
  CHECK(one == three);
  CHECK(one.size() == 4);
  CHECK(one.at(5) == test::approx(500.0).epsilon(0.1));
}
