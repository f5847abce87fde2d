// SPDX-License-Identifier: Apache-2.0
// The same iris in every renderer: curved, uneven, rotated, a picture.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/all_methods/methods.h"
#include "support/approx.h"
#include "support/pictures.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

constexpr double kIrisPlateRadius_mm = 3.0;

Iris flower(double rotation_rad) {
  Iris iris;
  iris.rotation_rad = rotation_rad;
  iris.field = flower_field();
  return iris;
}

LensState plate_with(const Iris& iris) {
  LensState lens = plate();
  lens.iris = iris;
  return lens;
}

// The fraction of a pixel that light through the stop covers: the plate's ghost is the stop's own image.
double fraction_of_pixel(const Iris& iris, const Frame& frame, int x, int y) {
  constexpr int kSamples = 8;
  int open = 0;
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const Vec2 pixel{x + (k % kSamples + 0.5) / kSamples, y + (k / kSamples + 0.5) / kSamples};
    open += iris_distance(iris, frame.sensor_from_pixel(pixel) * (1.0 / kIrisPlateRadius_mm)) <= 0.0 ? 1 : 0;
  }
  return static_cast<double>(open) / (kSamples * kSamples);
}

void check_plate(const Iris& iris) {
  const LensState lens = plate_with(iris);
  const test::Settings settings = green({80, 80, 0, 0, 80, 80, 0.08});
  const double area_mm2 = iris_area_fraction(iris) * std::numbers::pi * kIrisPlateRadius_mm * kIrisPlateRadius_mm;
  const double level = 0.04 * 0.04 * 0.08 * 0.08 / area_mm2;  // R^2 of the light, constant over the opening
  std::vector<double> fraction(80 * 80);
  for (int k = 0; k < 80 * 80; ++k)
    fraction[static_cast<std::size_t>(k)] = fraction_of_pixel(iris, settings.frame, k % 80, k / 80);
  for_each_method([&](const Bounds& bounds) {
    const Image image = image_of(bounds, lens, Light{}, settings);
    double squares = 0.0;
    double worst = 0.0;
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 80; ++x) {
        const double expected = fraction[static_cast<std::size_t>(y * 80 + x)];
        const double off = std::abs(image.at(x, y) / level - expected);
        squares += off * off;
        if (expected == 0.0 || expected == 1.0) worst = std::max(worst, off);
      }
    }
    // Counting has errors of up to 1/16 where an edge runs along a pixel's side; a picture's details of 0.3 pixels are
    // averaged.
    CHECK(std::sqrt(squares / (80 * 80)) < (bounds.traits.integrates_pixels ? 0.012 : 0.15));
    CHECK(worst < (bounds.traits.integrates_pixels ? 0.1 : 1.001));
    CHECK(sum(image) / 3.0 / (0.04 * 0.04) == test::approx(1.0).epsilon(std::max(bounds.flux, 5e-3)));
  });
}

}  // namespace

TEST_CASE("a plate's ghost has the shape, the place and the area of the iris") {
  for (const Iris& iris : {Iris{5, 0.3, 0.4}, Iris{9, 0.1, 0.2, 1.0, 0.1, 7}, Iris{3, 0.2, 1.0, 0.8, 0.4, 1},
                           Iris{8, 0.0, 0.0, 1.05}, Iris{6, 0.0, 0.3, 1.04, 0.05, 2}, Iris{20, 0.0, 0.5},
                           Iris{4, 0.2, 1e-4}, Iris{4, 0.2, 2e-5}, Iris{100, 0.0, 0.5, 0.6}}) {
    CAPTURE(iris.blades);
    CAPTURE(iris.curvature);
    check_plate(iris);
  }
}

TEST_CASE("a plate's ghost is the picture, right side up and turned as asked") {
  check_plate(flower(0.0));
  check_plate(flower(1.1));
}

TEST_CASE("every number of blades, the ends of every range") {
  for (int blades = 3; blades <= 20; ++blades) {
    for (const double curvature : {0.0, 1.0}) {
      CAPTURE(blades);
      const LensState lens = plate_with({blades, -2.0, curvature, 1.0, 0.5, static_cast<std::uint32_t>(blades)});
      const test::Settings settings = green({40, 40, 0, 0, 40, 40, 0.16});
      for_each_method([&](const Bounds& bounds) {
        if (bounds.traits.is_slow && blades % 8 != 0) return;
        const double flux = sum(image_of(bounds, lens, Light{}, settings)) / 3.0 / (0.04 * 0.04);
        CHECK(flux == test::approx(1.0).epsilon(std::max(bounds.flux, 2e-3)));
      });
    }
  }
}

TEST_CASE("blades that leave a circle give the round iris's bits") {
  const test::Settings settings = small_frame(bundled("heliar"), 96, 64);
  const Image round = image_of(bounds_of("adaptive"), bundled("heliar", {.f_number = 3.5}),
                               light_at(bundled("heliar"), settings.frame, {0.7, 0.33}), settings);
  CHECK(sum(round) > 0.0);
  for_each_method([&](const Bounds& bounds) {
    if (bounds.traits.is_exact) return;
    const auto drawn = [&](const LensSettings& lens_settings) {
      const LensState lens = bundled("heliar", lens_settings);
      return image_of(bounds, lens, light_at(lens, settings.frame, {0.7, 0.33}), settings).pixels;
    };
    const auto expected = drawn({.f_number = 3.5});
    CHECK(drawn({.f_number = 3.5, .iris = {9, 0.2, 1.0}}) == expected);
    CHECK(drawn({.f_number = 3.5, .iris = {6, 0.0, 0.0, 1.2}}) == expected);
    CHECK(drawn({.f_number = 3.5, .iris = {6, 0.0, 0.3}, .iris_closing = IrisClosing::Mechanism}) == expected);
    // At f/11 the mechanism's round blades equal the round stop, up to rounding of its radius.
    const auto stopped = drawn({.f_number = 11.0});
    const auto closed = drawn({.f_number = 11.0, .iris = {6, 0.0, 1.0}, .iris_closing = IrisClosing::Mechanism});
    double worst = 0.0, peak = 0.0;
    for (std::size_t k = 0; k < stopped.size(); ++k) {
      worst = std::max(worst, std::abs(static_cast<double>(stopped[k]) - closed[k]));
      peak = std::max(peak, static_cast<double>(stopped[k]));
    }
    if (bounds.traits.integrates_pixels) CHECK(worst <= 1e-3 * peak);
  });
}

TEST_CASE("a white picture is the round iris, to the error of its edge [slow]") {
  const LensState round = bundled("heliar", {.f_number = 11.0});
  LensState white = round;
  white.iris.field = drawn_field(64, [](Vec2) { return 1.0; });
  const test::Settings settings = small_frame(round, 96, 64);
  const Light light = light_at(round, settings.frame, {0.7, 0.33});
  for_each_method([&](const Bounds& bounds) {
    CHECK(psnr_db(image_of(bounds, round, light, settings), image_of(bounds, white, light, settings)) >=
          (bounds.traits.integrates_pixels ? 55.0 : 40.0));
  });
}

TEST_CASE("curved and uneven blades and pictures, the same bits for any number of threads") {
  for (const Iris& iris : {Iris{7, 0.3, 0.4, 1.02, 0.1, 3}, flower(0.4)}) {
    const LensState lens = bundled("heliar", {.f_number = 8.0, .iris = iris});
    test::Settings settings = small_frame(lens, 48, 32);
    settings.set_grid(48);
    settings.reference.density = 0.3;
    const Light light = light_at(lens, settings.frame, {0.7, 0.33});
    for_each_method([&](const Bounds& bounds) {
      const auto one = flare_of(bounds.method, lens, {&light, 1}, settings, {.threads = 1}).image.pixels;
      CHECK(flare_of(bounds.method, lens, {&light, 1}, settings, {.threads = 5}).image.pixels == one);
    });
  }
}

TEST_CASE("curved and uneven blades, as in the reference [slow]") {
  for (const Iris& iris : {Iris{5, 0.3, 0.5}, Iris{9, 0.1, 0.2, 1.0, 0.1, 7}, Iris{6, 0.2, 0.3, 1.05, 0.03, 2}}) {
    CAPTURE(iris.blades);
    const LensState lens = bundled("heliar", {.f_number = 11.0, .iris = iris});
    test::Settings settings = small_frame(lens, 96, 64);
    settings.reference.density = 1.4;  // at 1 it has errors at an iris's corners
    const Light light = light_at(lens, settings.frame, {0.70, 0.33});
    const Image truth = kept_truth_of("blades-" + std::to_string(iris.blades), lens, light, settings);
    CHECK(sum(truth) > 0.0);
    for_each_method([&](const Bounds& bounds) {
      if (!bounds.traits.is_exact) check_against(truth, image_of(bounds, lens, light, settings), bounds);
    });
  }
}

TEST_CASE("a picture as the iris, as in the reference [slow]") {
  for (const double f_number : {5.6, 11.0}) {
    const LensState lens = bundled("heliar", {.f_number = f_number, .iris = flower(0.3)});
    test::Settings settings = small_frame(lens, 96, 64);
    settings.reference.density = 1.4;
    const Light light = light_at(lens, settings.frame, {0.70, 0.33});
    const Image truth = kept_truth_of(f_number < 8.0 ? "flower-wide" : "flower-closed", lens, light, settings);
    CHECK(sum(truth) > 0.0);
    for_each_method([&](Bounds bounds) {
      if (bounds.traits.is_exact) return;
      check_against(truth, image_of(bounds, lens, light, settings), bounds);
    });
  }
}
