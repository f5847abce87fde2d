// SPDX-License-Identifier: Apache-2.0
// Lights at a finite distance in every renderer: closed forms, the reference, and the distance from which a light
// counts as distant.
#include <cmath>
#include <limits>
#include <numbers>

#include "contrejour/expert/first_order.h"
#include "render/all_methods/methods.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

Light near_light(const LensState& lens, const Frame& frame, Vec2 uv, double distance_mm) {
  Light light;
  light.distance_mm = distance_mm;
  light.direction = direction_for_image_point(lens, frame.sensor_from_uv(uv), lens.design_wavelength_nm, distance_mm);
  return light;
}

// The pixels of the disc of this radius about the middle: their mean, and the largest deviation from it.
struct Disc {
  double mean = 0, unevenness = 0;
};
Disc disc_of(const Image& image, double pitch_mm, double radius_mm) {
  Disc disc;
  int count = 0;
  const auto inside = [&](int x, int y) {
    return std::hypot(x + 0.5 - 0.5 * image.width, y + 0.5 - 0.5 * image.height) * pitch_mm < radius_mm;
  };
  const auto for_each = [&](auto visit) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (inside(x, y)) visit(image.at(x, y));
  };
  for_each([&](float v) {
    disc.mean += v;
    ++count;
  });
  disc.mean /= count;
  for_each([&](float v) { disc.unevenness = std::max(disc.unevenness, std::abs(v / disc.mean - 1.0)); });
  return disc;
}

}  // namespace

TEST_CASE("a plate's ghost of a light at half a metre is the stop's shadow, as large as the way there and back says") {
  const LensState lens = plate();
  const test::Settings settings = green({120, 120, 0, 0, 120, 120, 0.08});
  for (const double distance_mm : {500.0, 60.0}) {
    CAPTURE(distance_mm);
    Light light;
    light.distance_mm = distance_mm;
    // 8 mm of air and three times 2 mm of glass behind the stop; all the light through the stop, times R^2.
    const double radius_mm = 3.0 * (distance_mm + 8.0 + 6.0 / 1.5) / distance_mm;
    const double level = 0.04 * 0.04 * 0.08 * 0.08 / (std::numbers::pi * radius_mm * radius_mm);
    for_each_method([&](const Bounds& bounds) {
      const Image image = image_of(bounds, lens, light, settings);
      const Disc inner = disc_of(image, 0.08, radius_mm - 0.2);
      CHECK(inner.mean == test::approx(level).epsilon(0.005));
      CHECK(inner.unevenness < 0.012);  // at 60 mm the cosines fall by 0.5 per cent to the rim
      CHECK(sum(image) / 3.0 == test::approx(0.04 * 0.04).epsilon(std::max(bounds.flux, 2e-3)));
      double stray = 0.0;
      for (int x = 0; x < 120; ++x)
        if (std::abs(x + 0.5 - 60.0) * 0.08 > radius_mm + 0.2) stray = std::max<double>(stray, image.at(x, 60));
      CHECK(stray < 1e-6 * level);
    });
  }
}

TEST_CASE("a light at a kilometre is a distant one; at infinity to the last bit") {
  const LensState lens = bundled("heliar", {.f_number = 11.0});
  test::Settings settings = small_frame(lens, 96, 64);
  settings.reference.density = 0.3;
  const Light distant = light_at(lens, settings.frame, {0.70, 0.33});
  const Light far = near_light(lens, settings.frame, {0.70, 0.33}, 1e6);
  Light farther = distant;
  farther.distance_mm = 1e300;
  for_each_method([&](const Bounds& bounds) {
    const Image truth = image_of(bounds, lens, distant, settings);
    // With one sample for each pixel, edges are steps: one pixel of a thousand may change there.
    // `polynomial` evaluates the distant light and traces the other: its transmittances may differ by 0.2 per cent.
    const double least_db = bounds.method == "polynomial" ? 54.0 : bounds.traits.integrates_pixels ? 60.0 : 40.0;
    CHECK(psnr_db(truth, image_of(bounds, lens, far, settings)) > least_db);
    CHECK(image_of(bounds, lens, farther, settings).pixels == truth.pixels);
  });
}

TEST_CASE("lights at half a metre and nearer, as in the reference [slow]") {
  struct Case {
    const char* lens;
    LensSettings settings;
    Vec2 uv;
    double distance_mm;
  };
  for (const Case& c :
       {Case{"heliar", {.f_number = 11.0}, {0.70, 0.33}, 500.0}, Case{"heliar", {.f_number = 5.6}, {0.35, 0.6}, 60.0},
        Case{"tessar", {.f_number = 11.0, .object_distance_mm = 500.0}, {0.3, 0.7}, 500.0}}) {
    const std::string what(c.lens);
    CAPTURE(what);
    CAPTURE(c.distance_mm);
    const LensState lens = bundled(c.lens, c.settings);
    test::Settings settings = small_frame(lens, 96, 64);
    settings.reference.density = 0.5;
    const Light light = near_light(lens, settings.frame, c.uv, c.distance_mm);
    const Image truth = truth_of(lens, light, settings);
    CHECK(sum(truth) > 0.0);
    // The picture differs from that of a distant light.
    CHECK(psnr_db(truth, image_of(bounds_of("bundle"), lens, light_at(lens, settings.frame, c.uv), settings)) < 40.0);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_exact) return;
      check_against(truth, image_of(bounds, lens, light, settings), bounds);
    });
  }
}

TEST_CASE("a near light's ghosts near the axis are where the lens's matrices say") {
  const LensState lens = bundled("heliar");
  for (const double distance_mm : {kFar, 500.0, 50.0}) {
    CAPTURE(distance_mm);
    const LightSource light({0.0, 0.0, 1.0}, distance_mm);
    for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::OneSideOfStop)) {
      const Abcd m = abcd_ghost(lens, ghost, 550.0);
      const double height_mm = 1e-4;
      const TracedRay ray =
          trace(ghost_path(lens, ghost, 550.0), {{0.0, height_mm, 0.0}, light.direction_at({0.0, height_mm, 0.0})});
      const double expected = m.a * height_mm + m.b * height_mm / distance_mm;
      CHECK(ray.sensor_mm.y == test::approx(expected).epsilon(1e-4));
    }
  }
}

TEST_CASE("lights that cannot be: refused with a reason, the nearest that can render") {
  const LensState lens = bundled("heliar", {.f_number = 11.0});
  test::Settings settings = small_frame(lens, 24, 16);
  settings.reference.density = 0.3;
  for (const double distance_mm : {0.0, -5.0, std::nan(""), 1e-3, 0.05}) {
    CAPTURE(distance_mm);
    Light light;
    light.distance_mm = distance_mm;
    for_each_method([&](const Bounds& bounds) {
      const auto refused = render(bounds.method, lens, std::span(&light, 1), settings);
      REQUIRE_FALSE(refused.has_value());
      CHECK(refused.error().code == ErrorCode::InvalidArgument);
      CHECK(refused.error().message.find("light 1") == 0);
    });
  }
  for (const double distance_mm : {0.2, 3.0, 30.0}) {
    CAPTURE(distance_mm);
    Light light;
    light.distance_mm = distance_mm;
    const Image truth = truth_of(lens, light, settings);
    for_each_method([&](const Bounds& bounds) {
      const Image image = image_of(bounds, lens, light, settings);  // every value is a finite number
      // With so few pixels, sampled at their middles, small ghosts may be missed.
      CHECK(sum(image) / sum(truth) == test::approx(1.0).epsilon(bounds.traits.integrates_pixels ? 0.05 : 0.5));
    });
  }
}

TEST_CASE("lights at several distances add, whatever the threads [slow]") {
  const LensState lens = bundled("heliar", {.f_number = 11.0});
  test::Settings settings = small_frame(lens, 48, 32);
  settings.reference.density = 0.2;
  const Light lights[] = {near_light(lens, settings.frame, {0.7, 0.3}, 300.0),
                          near_light(lens, settings.frame, {0.3, 0.4}, 2000.0),
                          light_at(lens, settings.frame, {0.4, 0.8})};
  for_each_method([&](const Bounds& bounds) {
    const Image one = flare_of(bounds.method, lens, lights, settings, {.threads = 1}).image;
    const Image three = flare_of(bounds.method, lens, lights, settings, {.threads = 3}).image;
    CHECK(one.pixels == three.pixels);
    double apart = 0.0;
    for (const Light& light : lights) apart += sum(image_of(bounds, lens, light, settings));
    CHECK(sum(one) == test::approx(apart).epsilon(std::max(bounds.flux, 1e-4)));
  });
}
