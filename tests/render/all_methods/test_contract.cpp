// SPDX-License-Identifier: Apache-2.0
// The contract of render() for every method: lights, frames, threads, cancelling.
#include <atomic>
#include <limits>
#include <numbers>

#include "render/all_methods/methods.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

LensState heliar() { return bundled("heliar", {.f_number = 16.0}); }

// A coarse frame, for tests that render many.
test::Settings quick_frame(const LensState& lens, int width, int height) {
  test::Settings settings = small_frame(lens, width, height);
  settings.reference.density = 0.3;
  return settings;
}

Image part_of(const Image& image, const Frame& window) {
  Image part(window.width, window.height, 3);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      for (int c = 0; c < 3; ++c) part.at(x, y, c) = image.at(x + window.origin_x, y + window.origin_y, c);
    }
  }
  return part;
}

// Averages each 2 x 2 pixels to one.
Image binned(const Image& image) {
  Image out(image.width / 2, image.height / 2, 3);
  for (int y = 0; y < 2 * out.height; ++y) {
    for (int x = 0; x < 2 * out.width; ++x) {
      for (int c = 0; c < 3; ++c) out.at(x / 2, y / 2, c) += image.at(x, y, c);
    }
  }
  return out;
}

Image sum_of(const Image& a, const Image& b, float times_b) {
  Image sum = a;
  for (std::size_t k = 0; k < sum.pixels.size(); ++k) sum.pixels[k] += times_b * b.pixels[k];
  return sum;
}

}  // namespace

TEST_CASE("no light, no flare") {
  const LensState lens = heliar();
  const test::Settings settings = quick_frame(lens, 33, 18);
  for_each_method([&](const Bounds& bounds) {
    CHECK(image_of(bounds, lens, std::span<const Light>(), settings).pixels == Pixels(33 * 18 * 3, 0.0F));
  });
}

TEST_CASE("flare is linear in the light, and lights add [slow]") {
  const LensState lens = heliar();
  const test::Settings settings = quick_frame(lens, 48, 32);
  Light a = light_at(lens, settings.frame, {0.7, 0.33});
  Light b = light_at(lens, settings.frame, {0.25, 0.75});
  b.value = {3.0, 0.5, 0.0};
  for_each_method([&](const Bounds& bounds) {
    a.value = {1.0, 1.0, 1.0};
    const Image once = image_of(bounds, lens, a, settings);
    const Image other = image_of(bounds, lens, b, settings);
    const Image both = image_of(bounds, lens, std::vector<Light>{a, b}, settings);
    CHECK(largest_difference(sum_of(once, other, 1.0F), both) <= bounds.addition * peak_of(both));
    a.value = {1000.0, 1000.0, 1000.0};
    const Image bright = image_of(bounds, lens, a, settings);
    CHECK(largest_difference(sum_of(bright, once, -999.0F), once) <= 1e-3 * peak_of(once));
    CHECK(sum(bright) / (1000.0 * sum(once)) == test::approx(1.0).epsilon(1e-5));
  });
}

TEST_CASE("a window of the frame is that part of it") {
  const LensState lens = heliar();
  test::Settings settings = quick_frame(lens, 120, 80);
  const Light light = light_at(lens, settings.frame, {0.7, 0.33});
  Frame window = settings.frame;
  window.origin_x = 37;
  window.origin_y = 11;
  window.width = 51;
  window.height = 40;
  for_each_method([&](const Bounds& bounds) {
    settings.frame = frame_on_sensor(lens, 120, 80);
    const Image whole = image_of(bounds, lens, light, settings);
    settings.frame = window;
    const Image part = image_of(bounds, lens, light, settings);
    CHECK(sum(part) > 0.0);
    CHECK(largest_difference(part_of(whole, window), part) <= bounds.addition * peak_of(whole));
  });
}

TEST_CASE("finer pixels share the light of coarser ones [slow]") {
  const LensState lens = heliar();
  const test::Settings coarse = small_frame(lens, 80, 52);
  test::Settings fine = coarse;
  fine.frame = frame_on_sensor(lens, 160, 104);
  const Light light = light_at(lens, coarse.frame, {0.7, 0.33});
  for_each_method([&](const Bounds& bounds) {
    const Image once = image_of(bounds, lens, light, coarse);
    const Image twice = binned(image_of(bounds, lens, light, fine));
    CHECK(psnr_db(once, twice) >= std::min(bounds.psnr_db, 55.0) - (bounds.traits.integrates_pixels ? 0.0 : 6.0));
    CHECK(sum(twice) / sum(once) == test::approx(1.0).epsilon(std::max(bounds.flux, 2e-3)));
  });
}

TEST_CASE("a frame of one pixel holds what all pixels of the same area hold [slow]") {
  const LensState lens = heliar();
  const double width_mm = lens.sensor_height_mm;
  const test::Settings many = green({64, 64, 0, 0, 64, 64, width_mm / 64});
  test::Settings one = many;
  one.frame = {1, 1, 0, 0, 1, 1, width_mm};
  const Light light = light_at(lens, many.frame, {0.7, 0.4});
  for_each_method([&](const Bounds& bounds) {
    const double all = sum(image_of(bounds, lens, light, many));
    const double single = sum(image_of(bounds, lens, light, one));
    if (bounds.traits.integrates_pixels) CHECK(single == test::approx(all).epsilon(0.01));
  });
}

TEST_CASE("the order in which wavelengths are given does not matter [slow]") {
  const LensState lens = heliar();
  test::Settings settings = quick_frame(lens, 48, 32);
  settings.set_grid(48);
  const std::vector<Light> lights{light_at(lens, settings.frame, {0.7, 0.33})};
  for_each_method([&](const Bounds& bounds) {
    settings.lambda_nm = {430, 480, 530, 580, 630, 680};
    const Image rising = image_of(bounds, lens, lights, settings);
    settings.lambda_nm = {530, 680, 430, 580, 480, 630};
    CHECK(image_of(bounds, lens, lights, settings).pixels == rising.pixels);
  });
}

TEST_CASE("the same bits for 1, 2 and 7 threads") {
  const LensState lens = heliar();
  test::Settings settings = quick_frame(lens, 48, 32);
  settings.set_grid(48);
  const std::vector<Light> lights{light_at(lens, settings.frame, {0.7, 0.33}),
                                  light_at(lens, settings.frame, {0.25, 0.75})};
  for_each_method([&](const Bounds& bounds) {
    const Flare one = flare_of(bounds.method, lens, lights, settings, {.threads = 1});
    for (const int threads : {2, 7}) {
      CHECK(flare_of(bounds.method, lens, lights, settings, {.threads = threads}).image.pixels == one.image.pixels);
    }
    CHECK(one.statistics.method == bounds.method);
    CHECK(one.statistics.rays > 0);
    CHECK(one.statistics.surface_hits > one.statistics.rays);
    REQUIRE_FALSE(one.statistics.time_ms.empty());
    CHECK(one.statistics.time_ms.back().first == "total");
  });
}

TEST_CASE("an interrupted render says so, before it begins and midway") {
  const LensState lens = heliar();
  const test::Settings settings = quick_frame(lens, 64, 36);
  const Light light = light_at(lens, settings.frame, {0.7, 0.33});
  for_each_method([&](const Bounds& bounds) {
    std::atomic<bool> cancel{true};
    Context context;
    context.cancel = &cancel;
    const auto stopped = render(bounds.method, lens, {&light, 1}, settings, context);
    REQUIRE_FALSE(stopped.has_value());
    CHECK(stopped.error().code == ErrorCode::Cancelled);
    cancel = false;
    context.progress = [&](double done) { cancel = done < 1.0; };
    const auto midway = render(bounds.method, lens, {&light, 1}, settings, context);
    if (!midway) CHECK(midway.error().code == ErrorCode::Cancelled);
  });
}

TEST_CASE("lights at grazing angles give finite flares; directions that are none are refused") {
  const LensState lens = heliar();
  const test::Settings settings = quick_frame(lens, 32, 18);
  for_each_method([&](const Bounds& bounds) {
    Light light;
    for (const double angle_deg : {60.0, 85.0, 89.0}) {
      light.direction = direction_from_angles(angle_deg * std::numbers::pi / 180.0, 0.0);
      (void)image_of(bounds, lens, light, settings);
    }
    light.direction = {0.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
    const auto refused = render(bounds.method, lens, {&light, 1}, settings);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::InvalidArgument);
  });
}

TEST_CASE("a light that moves by a hundredth of a pixel changes no pixel by a jump") {
  const LensState lens = bundled("heliar", {.f_number = 8.0});
  const test::Settings settings = quick_frame(lens, 96, 64);
  constexpr int kSteps = 4;
  const auto light_after = [&](int steps) {
    return light_at(lens, settings.frame, {0.70 + 0.01 * steps / settings.frame.width, 0.33});
  };
  const Image truth = truth_of(lens, light_after(0), settings);
  const double natural = largest_difference(truth, truth_of(lens, light_after(1), settings));
  for_each_method([&](const Bounds& bounds) {
    if (bounds.traits.is_exact) return;
    Image before = image_of(bounds, lens, light_after(0), settings);
    for (int step = 1; step <= kSteps; ++step) {
      Image after = image_of(bounds, lens, light_after(step), settings);
      CHECK(largest_difference(before, after) <= 1.5 * natural + bounds.jump * peak_of(truth));
      before = std::move(after);
    }
  });
}
