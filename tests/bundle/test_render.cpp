// The whole renderer: contract, threads, and every system against the reference.
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "bundle/scene.h"
#include "contrejour/metrics.h"
#include "render/bundle/bundle.h"
#include "render/reference/reference.h"

using namespace contrejour;

namespace {

RenderSettings settings_for(const LensState& lens, int width, int height, int grid) {
  RenderSettings settings;
  settings.frame = frame_on_sensor(lens, width, height);
  settings.lambda_nm = {550.0};
  settings.grid = grid;
  return settings;
}

Light light_at(const LensState& lens, const Frame& frame, Vec2 uv) {
  Light light;
  light.direction = direction_to_land_at(lens, frame.sensor_from_uv(uv), 550.0);
  return light;
}

Flare bundle_of(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                const Context& context = {}) {
  auto flare = render_bundle(lens, lights, settings, context);
  REQUIRE(flare.has_value());
  return *flare;
}

}  // namespace

TEST_CASE("the same bits for 1, 2 and 7 threads") {
  const LensState lens = test::lens("heliar", 16.0);
  RenderSettings settings = settings_for(lens, 160, 90, 48);
  settings.lambda_nm.clear();
  settings.wavelengths = 5;
  const std::vector<Light> lights{light_at(lens, settings.frame, {0.7, 0.33}),
                                  light_at(lens, settings.frame, {0.25, 0.75})};
  Context context;
  context.threads = 1;
  const Flare one = bundle_of(lens, lights, settings, context);
  for (const int threads : {2, 7}) {
    context.threads = threads;
    CHECK(bundle_of(lens, lights, settings, context).image.pixels == one.image.pixels);
  }
  CHECK(one.statistics.ghosts_rendered == 13);
  CHECK(one.statistics.rays > 0);
  CHECK(one.statistics.surface_hits > 10 * one.statistics.rays);
  CHECK(one.statistics.time_ms.back().first == "total");
}

TEST_CASE("flux within 0.5 per cent of the reference and at least 45 dB") {
  struct System {
    const char* name;
    double f_number;
    double focal_length_mm;
  };
  for (const System& system :
       {System{"heliar", 16.0, 0.0}, System{"tessar", 11.0, 0.0}, System{"itoh-zoom", 32.0, 123.0}}) {
    CAPTURE(system.name);
    const LensState lens = test::lens(system.name, system.f_number, system.focal_length_mm);
    const RenderSettings settings = settings_for(lens, 160, 90, 256);
    const Light light = light_at(lens, settings.frame, {0.70, 0.33});
    const auto truth = render_reference(lens, {&light, 1}, settings, {});
    REQUIRE(truth.has_value());
    const auto difference = compare(truth->image, bundle_of(lens, {&light, 1}, settings).image);
    REQUIRE(difference.has_value());
    CHECK(difference->psnr_db.value_or(1e9) > 45.0);
    for (const double ratio : difference->flux_ratio) CHECK(ratio == doctest::Approx(1.0).epsilon(0.005));
  }
}

TEST_CASE("bodonyi2023 eq. 13 spends fewer rays and stays close") {
  const LensState lens = test::lens("itoh-zoom", 32.0, 123.0);
  RenderSettings settings = settings_for(lens, 160, 90, 256);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Flare full = bundle_of(lens, {&light, 1}, settings);
  settings.scale_grid = true;
  const Flare scaled = bundle_of(lens, {&light, 1}, settings);
  CHECK(scaled.statistics.rays < full.statistics.rays / 2);
  const auto difference = compare(full.image, scaled.image);
  REQUIRE(difference.has_value());
  CHECK(difference->psnr_db.value_or(1e9) > 40.0);
  CHECK(difference->flux_ratio[1] == doctest::Approx(1.0).epsilon(0.01));
}

TEST_CASE("no light, no flare") {
  const LensState lens = test::lens("heliar", 16.0);
  const Flare flare = bundle_of(lens, {}, settings_for(lens, 32, 18, 32));
  CHECK(flare.image.pixels == std::vector<float>(32 * 18 * 3, 0.0F));
}

TEST_CASE("twice the light is twice the flare, two lights are the sum of each") {
  const LensState lens = test::lens("heliar", 16.0);
  const RenderSettings settings = settings_for(lens, 64, 36, 48);
  Light a = light_at(lens, settings.frame, {0.7, 0.33});
  const Light b = light_at(lens, settings.frame, {0.25, 0.75});
  const Image once = bundle_of(lens, {&a, 1}, settings).image;
  const Image other = bundle_of(lens, {&b, 1}, settings).image;
  const Image both = bundle_of(lens, std::vector<Light>{a, b}, settings).image;
  a.value = {2.0, 2.0, 2.0};
  const Image twice = bundle_of(lens, {&a, 1}, settings).image;
  for (std::size_t k = 0; k < once.pixels.size(); ++k) {
    CHECK(twice.pixels[k] == doctest::Approx(2.0 * once.pixels[k]).epsilon(1e-6));
    CHECK(both.pixels[k] == doctest::Approx(static_cast<double>(once.pixels[k]) + other.pixels[k]).epsilon(1e-5));
  }
}

TEST_CASE("lights at grazing angles and directions that are none") {
  const LensState lens = test::lens("heliar", 16.0);
  const RenderSettings settings = settings_for(lens, 32, 18, 32);
  Light light;
  light.direction = direction_from_angles(89.0 * std::numbers::pi / 180.0, 0.0);
  for (const float value : bundle_of(lens, {&light, 1}, settings).image.pixels) CHECK(std::isfinite(value));
  light.direction = {0.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
  CHECK_FALSE(render_bundle(lens, {&light, 1}, settings, {}).has_value());
}

TEST_CASE("grids out of range are refused, a set cancel flag is obeyed") {
  const LensState lens = test::lens("heliar", 16.0);
  const Light light;
  for (const int grid : {15, 513, -1}) {
    const auto refused = render_bundle(lens, {&light, 1}, settings_for(lens, 32, 18, grid), {});
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::InvalidArgument);
  }
  const std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  const auto stopped = render_bundle(lens, {&light, 1}, settings_for(lens, 32, 18, 32), context);
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::Cancelled);
}
