// SPDX-License-Identifier: Apache-2.0
// The C interface's pictures, compared with those of the C++ functions behind it.
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include "c_interface/c_objects.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::c_test;

TEST_CASE("C: a picture has the bits of the C++ interface's") {
  CObjects objects;
  const std::vector<float> pixels = rendered(objects, &objects.error);
  CHECK(same_bits(pixels, rendered_in_cpp("9,5:1000")));

  // The same light as a struct, in place of the settings' own. Two elements whose size is that of a later version.
  struct LaterLight {
    cj_light light;
    double member_of_later_version;
  };
  LaterLight lights[2] = {};
  for (LaterLight& later : lights) {
    later.light.struct_size = sizeof(LaterLight);
    REQUIRE(cj_direction_from_angles(9.0 * params::kDegree_rad, 5.0 * params::kDegree_rad, later.light.direction,
                                     nullptr) == CJ_OK);
    std::fill(std::begin(later.light.value), std::end(later.light.value), 500.0);
  }
  REQUIRE(cj_settings_reset(objects.settings, "light", &objects.error) == CJ_OK);
  std::vector<float> halves = black();
  const cj_image image = image_over(halves);
  REQUIRE(cj_renderer_render(objects.renderer, objects.settings, &lights[0].light, 2, &image, nullptr, nullptr,
                             &objects.error) == CJ_OK);
  double difference = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    difference += std::abs(static_cast<double>(pixels[k]) - static_cast<double>(halves[k]));
    sum += std::abs(static_cast<double>(pixels[k]));
  }
  CHECK(sum > 0.0);
  CHECK(difference < 1e-2 * sum);  // the method's error, for which 0.02 was asked
}

TEST_CASE("C: directions of lights are those of the settings' lights") {
  CObjects objects;
  const params::Values values = quick_values();
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  double direction[3] = {};
  REQUIRE(cj_direction_from_image(objects.state, objects.settings, 0.7, 0.33, 0.0, direction, &objects.error) == CJ_OK);
  const Vec3 expected = picture_request(values, *lens)->lights.front().direction;  // that of the default light
  CHECK(Vec3{direction[0], direction[1], direction[2]} == expected);
  CHECK(cj_direction_from_angles(2.0, 0.0, direction, &objects.error) == CJ_INVALID_ARGUMENT);
  CHECK(direction[0] == expected.x);
}

TEST_CASE("C: rows from the bottom, in half floats with alpha, hold the same picture") {
  CObjects objects;
  const std::vector<float> pixels = rendered(objects, &objects.error);
  constexpr std::uint16_t kUntouched = 0x3c00;
  std::vector<std::uint16_t> host(std::size_t{4} * kWidth * kHeight, kUntouched);
  cj_image image = CJ_INIT(cj_image);
  image.width = kWidth;
  image.height = kHeight;
  image.sample = CJ_HALF;
  image.pixel_step = 8;
  image.row_step = -8 * kWidth;
  image.pixels = host.data() + std::size_t{4} * kWidth * (kHeight - 1);
  cj_statistics statistics = CJ_INIT(cj_statistics);
  REQUIRE(cj_renderer_render(objects.renderer, objects.settings, nullptr, 0, &image, nullptr, &statistics,
                             &objects.error) == CJ_OK);
  CHECK(statistics.ghosts_rendered > 5);
  CHECK(statistics.rays > 0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint16_t* const at =
          host.data() + std::size_t{4} * (std::size_t(kHeight - 1 - y) * kWidth + std::size_t(x));
      REQUIRE(at[3] == kUntouched);
      const float expected = pixels[std::size_t{3} * (std::size_t(y) * kWidth + std::size_t(x))];
      const double value =
          std::ldexp((at[0] & 0x3ff) + ((at[0] & 0x7c00) != 0 ? 1024 : 0), std::max(1, (at[0] & 0x7c00) >> 10) - 25);
      REQUIRE(value == test::approx(std::abs(expected)).epsilon(1e-3).scale(1e-3));
    }
  }
}

TEST_CASE("C: the flare of a photograph in memory") {
  CObjects objects;
  REQUIRE(cj_settings_reset(objects.settings, "light", &objects.error) == CJ_OK);
  std::vector<float> pixels(black().size(), 0.1F);
  pixels[std::size_t{3} * (8 * kWidth + 34)] = 50000.0F;
  pixels[4] = std::numeric_limits<float>::quiet_NaN();
  Picture picture = picture_of(picture_in_cpp(pixels));
  const params::Values values = quick_values();
  const auto lens = params::lens_of(*find_lens("cooke-triplet"), values);
  const auto expected = apply_flare(picture, *lens, values);
  REQUIRE(expected.has_value());

  const cj_image image = image_over(pixels);
  std::vector<float> flare = black();
  const cj_image flare_image = image_over(flare);
  cj_flare_report report = CJ_INIT(cj_flare_report);
  REQUIRE(cj_apply(objects.state, objects.settings, &image, &flare_image, CJ_FLARE_ONLY, nullptr, &report,
                   &objects.error) == CJ_OK);
  CHECK(same_bits(flare, expected->flare.image));
  CHECK(report.lights_found == 1);
  REQUIRE(cj_apply(objects.state, objects.settings, &image, &image, CJ_PICTURE_WITH_FLARE, nullptr, nullptr,
                   &objects.error) == CJ_OK);
  CHECK(same_bits(pixels, picture.rgb));
}

TEST_CASE("C: calls stop when they are cancelled, and the renderer is usable afterwards") {
  CObjects objects;
  cj_cancel* cancel = nullptr;
  REQUIRE(cj_cancel_create(&cancel, &objects.error) == CJ_OK);
  std::vector<float> pixels = black();
  const cj_image image = image_over(pixels);
  cj_context context = CJ_INIT(cj_context);
  context.cancel = cancel;
  cj_cancel_set(cancel, 1);
  const auto render_once = [&] {
    return cj_renderer_render(objects.renderer, objects.settings, nullptr, 0, &image, &context, nullptr,
                              &objects.error);
  };
  CHECK(render_once() == CJ_CANCELLED);
  CHECK(objects.error.status == CJ_CANCELLED);
  cj_cancel_set(cancel, 0);
  CHECK(render_once() == CJ_OK);
  cj_cancel_destroy(cancel);

  double last = -1.0;
  context = CJ_INIT(cj_context);
  context.user = &last;
  context.progress = [](void* user, double done) -> std::int32_t {
    *static_cast<double*>(user) = done;
    return 1;
  };
  CHECK(render_once() == CJ_CANCELLED);
  CHECK(last >= 0.0);
}

TEST_CASE("C: two renderers on two threads draw the same picture") {
  CObjects first, second;
  std::vector<float> of_first, of_second;
  std::thread other([&] { of_second = rendered(second, nullptr); });
  of_first = rendered(first, nullptr);
  other.join();
  CHECK(of_first == of_second);
}
