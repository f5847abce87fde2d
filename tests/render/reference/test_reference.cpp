// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "render/reference/reference.h"
#include "support/approx.h"
#include "support/planned.h"
#include "support/scenes.h"

using namespace contrejour;

using test::bundled;
using test::green;
using test::light_at;
using test::sum;

namespace {

Image rendered(const LensState& lens, std::span<const Light> lights, const test::Settings& settings) {
  const auto flare = test::render_alone(render_reference, settings.reference, lens, lights, settings);
  REQUIRE(flare.has_value());
  return flare->image;
}

double psnr_db(const Image& a, const Image& b) { return compare(a, b).value().psnr_db.value_or(1000.0); }

Frame small_frame(const LensState& lens, int width = 96) { return frame_on_sensor(lens, width, width * 2 / 3); }

}  // namespace

TEST_CASE("a ghost with an affine map is uniform with the closed form's level") {
  const LensState lens = test::plate();
  Frame frame{200, 200, 0, 0, 200, 200, 0.05};
  Light light;
  light.direction = {0.0, 0.0, 1.0};
  const Image image = rendered(lens, {&light, 1}, green(frame));
  const double r = 0.04;
  // V = 1: E_ghost A_pixel / Phi = R^2 * pixel area / stop area.
  const double level = r * r * 0.05 * 0.05 / (std::numbers::pi * 9.0);
  float low = 1e30f;
  float high = 0.0f;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double from_centre = std::hypot(x + 0.5 - 100.0, y + 0.5 - 100.0) * 0.05;
      if (from_centre > 2.9) continue;
      low = std::min(low, image.at(x, y));
      high = std::max(high, image.at(x, y));
    }
  }
  CHECK(high / low < 1.005);
  CHECK(low / level == test::approx(1.0).epsilon(1e-3));
  CHECK(sum(image) / 3.0 / (r * r) == test::approx(1.0).epsilon(1e-3));
  CHECK(image.at(100, 30) == 0.0f);
}

TEST_CASE("doubling the density changes the picture by less than 55 dB [slow]") {
  const LensState heliar = bundled("heliar", {.f_number = 16.0});
  test::Settings settings = green(small_frame(heliar, 120));
  const Light light = light_at(heliar, settings.frame, {0.70, 0.33});
  const Image once = rendered(heliar, {&light, 1}, settings);
  settings.reference.density = 2.0;
  const Image twice = rendered(heliar, {&light, 1}, settings);
  CHECK(psnr_db(twice, once) > 55.0);
  CHECK(sum(once) / sum(twice) == test::approx(1.0).epsilon(2e-3));
}

TEST_CASE("the Heliar's flare at f/16 has the order of brightness that a first trial gave") {
  const LensState heliar = bundled("heliar", {.f_number = 16.0});
  const test::Settings settings = green(small_frame(heliar));
  const Light light = light_at(heliar, settings.frame, {0.75, 0.5});
  const double flux = sum(rendered(heliar, {&light, 1}, settings)) / 3.0;
  CHECK(flux > 0.5 * 2.2e-4);
  CHECK(flux < 2.0 * 2.2e-4);
}

TEST_CASE("a quarter turn of the light about the axis turns the flare [slow]") {
  const LensState lens = bundled("heliar", {.f_number = 8.0});
  Frame frame = frame_on_sensor(lens, 90, 90);
  const test::Settings settings = green(frame);
  const Light right = light_at(lens, frame, {0.8, 0.45});
  Light rotated = right;
  rotated.direction = {right.direction.y, -right.direction.x, right.direction.z};
  const Image a = rendered(lens, {&right, 1}, settings);
  const Image b = rendered(lens, {&rotated, 1}, settings);
  // u' = 1 - v, v' = u: every ghost moves as the light does.
  Image back = a;
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 90; ++x) {
      for (int c = 0; c < 3; ++c) back.at(x, y, c) = b.at(89 - y, x, c);
    }
  }
  const Vec2 landed = frame.uv_from_sensor(chief_ray_image_point(lens, rotated.direction, lens.design_wavelength_nm));
  CHECK(landed.x == test::approx(0.55).epsilon(1e-6));
  CHECK(landed.y == test::approx(0.8).epsilon(1e-6));
  CHECK(psnr_db(a, back) > 60.0);
}

TEST_CASE("a ghost of less than a pixel keeps its flux") {
  const LensState lens = test::plate();
  Frame frame{8, 8, 0, 0, 8, 8, 10.0};  // the stop's 6 mm within one pixel of 10 mm
  frame.full_width = frame.full_height = 9;
  Light light;
  light.direction = {0.0, 0.0, 1.0};
  const Image image = rendered(lens, {&light, 1}, green(frame));
  CHECK(sum(image) / 3.0 / (0.04 * 0.04) == test::approx(1.0).epsilon(2e-3));
}
