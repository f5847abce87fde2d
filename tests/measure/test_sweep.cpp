// SPDX-License-Identifier: Apache-2.0
// Simulated captures: where the light's image lands, what the exposures hold.
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "base/units.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/sweep.h"
#include "contrejour/expert/sweep_geometry.h"
#include "contrejour/frame.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

LensState heliar() { return *configure_lens(*find_lens("heliar"), {.f_number = 4.0}); }

SweepSettings small_sweep(const LensState& lens, int stations = 5) {
  SweepSettings settings;
  settings.angles_deg = even_angles_deg(0.8 * largest_angle_deg(lens), stations);
  settings.width = 240;
  settings.height = 160;
  return settings;
}

// The centroid of what is above half of the brightest.
Vec2 bright_centroid(const RawFrame& frame) {
  const double limit = frame.black_dn + 0.25 * (frame.white_dn - frame.black_dn);
  Vec2 sum{};
  double count = 0.0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto k = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
      if (frame.dn[k] < limit) continue;
      sum = sum + Vec2{x + 0.5, y + 0.5};
      ++count;
    }
  }
  return sum * (1.0 / count);
}

}  // namespace

TEST_CASE("sweep: the light's image moves as the head turns [slow]") {
  const LensState lens = heliar();
  SweepSettings settings = small_sweep(lens);
  settings.jitter_deg = settings.roll_deg = 0.0;
  const double focal_length_px =
      first_order(lens, 550.0).focal_length_mm / frame_on_sensor(lens, 240, 160).pixel_pitch_mm;
  for (const std::size_t k : {0U, 2U, 4U}) {
    const auto station = simulate_station(lens, settings, k);
    REQUIRE_MESSAGE(station.has_value(), station.error().to_string());
    CHECK(station->exposures.size() == 3);
    CHECK(station->background.size() == 3);
    const Vec2 at = bright_centroid(station->direct);
    CHECK(at.x == test::approx(125.0 + focal_length_px * std::tan(rad_from_deg(station->angle_deg))).epsilon(0.01));
    CHECK(at.y == test::approx(77.0).epsilon(0.01));
  }
}

TEST_CASE("sweep: the short exposure shows where the light is, to a tenth of a pixel [slow]") {
  const LensState lens = heliar();
  SweepSettings settings = small_sweep(lens);
  settings.angles_deg = {-0.9, -0.4, 0.0, 0.25, 0.6};  // so near the axis that the lens has no distortion
  settings.jitter_deg = settings.roll_deg = 0.0;
  const double focal_length_px =
      first_order(lens, 550.0).focal_length_mm / frame_on_sensor(lens, 240, 160).pixel_pitch_mm;
  for (std::size_t k = 0; k < settings.angles_deg.size(); ++k) {
    const auto station = simulate_station(lens, settings, k);
    REQUIRE_MESSAGE(station.has_value(), station.error().to_string());
    const auto at = direct_image_position(station->direct);
    REQUIRE(at.has_value());
    const double offset_px = focal_length_px * std::tan(rad_from_deg(settings.angles_deg[k]));
    CHECK(std::abs(at->x - 0.5 * (125.0 + offset_px)) < 0.1);
    CHECK(std::abs(at->y - 0.5 * 77.0) < 0.1);
  }
}

TEST_CASE("sweep: roll lifts the light's image, the zero moves it [slow]") {
  const LensState lens = heliar();
  SweepSettings settings = small_sweep(lens, 1);
  settings.angles_deg = {0.8 * largest_angle_deg(lens)};
  settings.jitter_deg = 0.0;
  settings.roll_deg = 3.0;
  const Vec2 rolled = bright_centroid(simulate_station(lens, settings, 0)->direct);
  settings.roll_deg = 0.0;
  const Vec2 level = bright_centroid(simulate_station(lens, settings, 0)->direct);
  CHECK(level.y - rolled.y == test::approx((level.x - 125.0) * std::tan(rad_from_deg(3.0))).epsilon(0.1));
  settings.zero_deg = 1.0;
  CHECK(bright_centroid(simulate_station(lens, settings, 0)->direct).x < level.x - 2.0);
}

TEST_CASE("sweep: ghosts reach into the exposures, the source saturates them [slow]") {
  const LensState lens = heliar();
  const auto station = simulate_station(lens, small_sweep(lens), 1);
  REQUIRE(station.has_value());
  const auto merged = merge_exposures(station->exposures, station->background);
  REQUIRE(merged.has_value());
  double brightest = 0.0, saturated = 0.0;
  for (std::size_t k = 0; k < merged->rate.pixels.size(); ++k) {
    if (merged->valid.pixels[k] == 0.0F)
      ++saturated;
    else
      brightest = std::max(brightest, static_cast<double>(merged->rate.pixels[k]));
  }
  CHECK(saturated > 3.0);
  CHECK(saturated < 0.05 * static_cast<double>(merged->rate.pixels.size()));
  CHECK(brightest > 2000.0);
  CHECK(simulate_station(lens, small_sweep(lens), 1, {.threads = 1})->exposures[1].dn == station->exposures[1].dn);
}

TEST_CASE("sweep: settings that make no sense are refused") {
  const LensState lens = heliar();
  SweepSettings settings = small_sweep(lens);
  CHECK(!simulate_station(lens, settings, 5));
  settings.width = 241;
  CHECK(!simulate_station(lens, settings, 0));
  settings = small_sweep(lens);
  settings.times_s = {};
  CHECK(!simulate_station(lens, settings, 0));
}
