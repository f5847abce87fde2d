// SPDX-License-Identifier: Apache-2.0
// Starbursts that a device adds to the ghosts, against those of the CPU, in all their dynamic range.
#include "device_frames.h"

using namespace contrejour;
using test::frame_by, test::kTwoLights, test::lens_of, test::settings_of, test::OnDevice;

namespace {

constexpr double kFaintest = 1e-11;  // of the peak: a fainter value is not compared by itself
constexpr double kLargestError = 0.001;  // of a pixel's own value
constexpr double kFloatBits = 2.5e-7;  // of a pixel's value with its ghosts: rounding of two sums

FrameSettings starburst_settings(const LensState& lens, int width = 96, int height = 54) {
  FrameSettings settings = settings_of(lens, width, height);
  settings.selection = SelectBrightest{2};
  settings.starburst.on = true;
  return settings;
}

// The starbursts of a picture, and the rounding errors of its floats.
struct Starbursts {
  std::vector<double> values, rounding;
};

Starbursts starbursts_of(const MethodOptions& method, const LensState& lens, std::span<const Light> lights,
                         FrameSettings settings, RenderCache& cache) {
  const Flare with = frame_by(method, lens, lights, settings, cache);
  settings.starburst.on = false;
  const Flare without = frame_by(method, lens, lights, settings, cache);
  Starbursts out;
  for (std::size_t k = 0; k < with.image.pixels.size(); ++k) {
    const double value = with.image.pixels[k];
    out.values.push_back(value - static_cast<double>(without.image.pixels[k]));
    out.rounding.push_back(kFloatBits * std::abs(value));
  }
  return out;
}

bool was_drawn_on_device(const RenderStatistics& statistics) {
  return std::ranges::any_of(statistics.time_ms, [](const auto& phase) { return phase.first == "device: starburst"; });
}

// Checks that the device drew the starbursts, and how far they are from those of the CPU.
void check_starbursts(OnDevice& device, const MethodOptions& method, const LensState& lens,
                      std::span<const Light> lights, const FrameSettings& settings) {
  const Starbursts exact = starbursts_of(method, lens, lights, settings, device.cpu_cache);
  const Starbursts got = starbursts_of(method, lens, lights, settings, device.cache);
  const double peak = *std::ranges::max_element(exact.values);
  double squares = 0.0, worst = 0.0, compared = 0.0;
  std::array<double, 3> flux{}, flux_got{};
  for (std::size_t k = 0; k < exact.values.size(); ++k) {
    const double error = std::abs(got.values[k] - exact.values[k]);
    squares += error * error;
    flux[k % 3] += exact.values[k];
    flux_got[k % 3] += got.values[k];
    if (exact.values[k] < kFaintest * peak) continue;
    compared += 1.0;
    worst = std::max(worst, (error - exact.rounding[k] - got.rounding[k]) / exact.values[k]);
  }
  const auto count = static_cast<double>(exact.values.size());
  const double psnr_db = 20.0 * std::log10(peak / std::sqrt(squares / count));
  INFO(lens.name, ": ", psnr_db, " dB, pixels off by ", worst, ", compared ", compared / count);
  CHECK(psnr_db > 100.0);
  CHECK(worst < kLargestError);
  CHECK(compared > 0.5 * count);
  for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(flux_got[c] / flux[c] - 1.0) < 1e-5);
  const Flare once = frame_by(method, lens, lights, settings, device.cache);
  CHECK(was_drawn_on_device(once.statistics));
  CHECK(frame_by(method, lens, lights, settings, device.cache).image.pixels == once.image.pixels);
}

}  // namespace

TEST_CASE("starbursts of round and bladed irises are drawn on the device") {
  OnDevice device;
  if (!device.kept.device) return;
  for (const int blades : {0, 7}) {
    const LensState lens = lens_of("heliar", blades, 11.0);
    check_starbursts(device, AdaptiveOptions{}, lens, std::span(kTwoLights).first(1), starburst_settings(lens));
  }
  test::check_no_messages();
}

TEST_CASE(
    "starbursts of several lights are drawn on the device: of other spectra, near, at one place, outside the frame") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("tessar", 6, 8.0);
  std::vector<Light> lights = kTwoLights;
  lights.push_back(lights[0]);  // shares a pattern
  lights.back().value = {0.5, 2.0, 0.1};
  lights.push_back(
      {.direction = direction_from_angles(-0.2, 0.03), .spectrum = BlackBody{3200.0}, .distance_mm = 900.0});
  lights.push_back({.direction = direction_from_angles(0.0, 0.45), .value = {1e4, 1e4, 1e4}});
  check_starbursts(device, AdaptiveOptions{}, lens, lights, starburst_settings(lens));
  test::check_no_messages();
}

TEST_CASE("starbursts are drawn on the device for bundle and tiled, and in bands of rows") {
  const LensState lens = lens_of("heliar", 5, 8.0);
  const FrameSettings settings = starburst_settings(lens, 64, 36);
  BundleOptions bundle;
  bundle.grid.rays = 24;
  TiledOptions tiled;
  tiled.grid.rays = 24;
  OnDevice whole, banded({.most_rows = 7});
  if (!whole.kept.device) return;
  for (const MethodOptions& method : {MethodOptions(bundle), MethodOptions(tiled), MethodOptions(AdaptiveOptions{})}) {
    check_starbursts(whole, method, lens, kTwoLights, settings);
    check_starbursts(banded, method, lens, kTwoLights, settings);
  }
  test::check_no_messages();
}

TEST_CASE("the patterns on the device are those of the frame's own lens and lights") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState one = lens_of("heliar", 5, 8.0), other = lens_of("heliar", 8, 16.0);
  const auto light = std::span(kTwoLights).first(1);
  const FrameSettings settings = starburst_settings(one, 64, 36);
  const Flare first = frame_by(AdaptiveOptions{}, one, light, settings, device.cache);
  const Flare second = frame_by(AdaptiveOptions{}, other, light, settings, device.cache);
  CHECK(first.image.pixels != second.image.pixels);
  CHECK(frame_by(AdaptiveOptions{}, one, light, settings, device.cache).image.pixels == first.image.pixels);
  CHECK(frame_by(AdaptiveOptions{}, one, kTwoLights, settings, device.cache).image.pixels != first.image.pixels);
  CHECK(frame_by(AdaptiveOptions{}, one, light, settings, device.cache).image.pixels == first.image.pixels);
}

TEST_CASE("starbursts that the device cannot add are added by the CPU [slow]") {
  const LensState lens = lens_of("heliar", 5, 8.0);
  const FrameSettings settings = starburst_settings(lens, 64, 36);
  OnDevice device, small({.most_buffer_bytes = 1U << 21U});
  if (!device.kept.device) return;
  const std::span<const Light> light = std::span(kTwoLights).first(1);
  const auto check_added = [&](OnDevice& by, std::span<const Light> lights, const FrameSettings& with) {
    const Flare wanted = frame_by(AdaptiveOptions{}, lens, lights, with, by.cpu_cache);
    const Flare flare = frame_by(AdaptiveOptions{}, lens, lights, with, by.cache);
    CHECK_FALSE(was_drawn_on_device(flare.statistics));
    const auto flux = test::fluxes_of(wanted.image), got = test::fluxes_of(flare.image);
    for (std::size_t c = 0; c < 3; ++c) CHECK(got[c] == doctest::Approx(flux[c]).epsilon(1e-5));
  };
  check_added(small, light, settings);  // the pattern does not fit into a buffer
  FrameSettings left_out = settings;
  left_out.starburst.left_out = std::make_shared<Image>(64, 36, 1);
  check_added(device, light, left_out);
  FrameSettings no_ghosts = settings;
  no_ghosts.selection = SelectBrightest{0};
  check_added(device, light, no_ghosts);
  FrameSettings few = settings;
  few.wavelengths = 1;
  few.selection = SelectBrightest{1};
  check_added(device, std::vector<Light>(kMostPlacedStarbursts + 1, light.front()), few);
}

TEST_CASE("glare and lights with a size are added to starbursts of the device") {
  OnDevice device;
  if (!device.kept.device) return;
  const LensState lens = lens_of("heliar", 5, 8.0);
  FrameSettings settings = starburst_settings(lens, 64, 36);
  settings.glare.fraction = 0.02;
  auto imaged = std::make_shared<std::vector<Light>>(kTwoLights);
  imaged->back().radius_rad = 0.005;
  settings.starburst.lights = imaged;
  const auto light = std::span(kTwoLights).first(1);
  const Flare wanted = frame_by(AdaptiveOptions{}, lens, light, settings, device.cpu_cache);
  const Flare got = frame_by(AdaptiveOptions{}, lens, light, settings, device.cache);
  CHECK(was_drawn_on_device(got.statistics));
  const test::Agreement agreement = test::agreement_of(wanted.image, got.image);
  CHECK(agreement.psnr_db > 100.0);
  CHECK(agreement.flux_error < 1e-5);
}
