// SPDX-License-Identifier: Apache-2.0
// Lights of a photograph as areas: a disc that leaves the picture fades in proportion to its remaining part.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/apply.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::params;

namespace {

constexpr int kWidth = 96, kHeight = 64;
constexpr double kRadius = 7.0;

// A disc of constant brightness about a point; pixels at its rim have the fraction that it covers.
Picture picture_of_disc(double x, double y) {
  Image rgb(kWidth, kHeight);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      int inside = 0;
      for (int k = 0; k < 64; ++k)
        if (std::hypot(column + (k % 8 + 0.5) / 8.0 - x, row + (k / 8 + 0.5) / 8.0 - y) < kRadius) ++inside;
      for (int c = 0; c < 3; ++c) rgb.at(column, row, c) = static_cast<float>(100.0 * inside / 64.0 + 0.01);
    }
  }
  return picture_of(rgb);
}

struct Outcome {
  double value = 0.0;  // of all lights
  Image flare;
};

Outcome applied(const Picture& picture, const LensState& lens, const Values& values) {
  const auto plan = plan_flare(picture, lens, values);
  REQUIRE(plan.has_value());
  Outcome out;
  for (const Light& light : plan->lights) out.value += light.value[1];
  auto flare = render_flare(*plan, picture.rgb, lens, values);
  REQUIRE(flare.has_value());
  out.flare = std::move(flare->image);
  return out;
}

double difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) sum += std::abs(a.pixels[k] - b.pixels[k]);
  return sum;
}

double total(const Image& image) {
  double sum = 0.0;
  for (const float v : image.pixels) sum += std::abs(v);
  return sum;
}

Values values_of(std::vector<std::pair<const char*, const char*>> given) {
  Values values;
  for (const auto& [name, text] : given) REQUIRE(values.set(name, text).has_value());
  return values;
}

LensState planar() {
  const auto lens = find_lens("planar-50");
  REQUIRE(lens.has_value());
  const auto state = configure_lens(*lens, {.f_number = 8.0});
  REQUIRE(state.has_value());
  return *state;
}

}  // namespace

TEST_CASE("a disc of pixels that leaves the picture fades as its visible area does [slow]") {
  const LensState lens = planar();
  const Values values = values_of({{"threshold", "2"}, {"wavelengths", "1"}, {"error", "final"}});
  const double whole = applied(picture_of_disc(70.0, 20.0), lens, values).value;
  constexpr double kStep = 0.5;
  Outcome last = applied(picture_of_disc(kWidth - kRadius - 1.0, 20.0), lens, values);
  CHECK(last.value == test::approx(whole).epsilon(0.02));
  const double largest = total(last.flare);
  REQUIRE(largest > 0.0);
  for (double x = kWidth - kRadius - 1.0 + kStep; x < kWidth + kRadius + 1.0; x += kStep) {
    CAPTURE(x);
    const Outcome now = applied(picture_of_disc(x, 20.0), lens, values);
    // A step uncovers at most a strip of the disc's diameter.
    const double strip = 2.0 * kRadius * kStep / (3.14159 * kRadius * kRadius);
    CHECK(std::abs(now.value - last.value) < 1.1 * strip * whole);
    CHECK(now.value < last.value + 0.005 * whole);
    // The flare moves as well, by half a pixel or less.
    CHECK(difference(now.flare, last.flare) < 2.5 * strip * largest);
    last = now;
  }
  CHECK(last.value == 0.0);
  CHECK(total(last.flare) == 0.0);
}

// A window of coloured panes, a thin lamp and a spark, 8 decades brighter than the wall.
Picture picture_of_window() {
  Image rgb(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool pane = y >= 10 && y < 34 && x >= 20 && x < 56 && x % 12 > 1 && y % 12 > 1;
      const bool lamp = y == 50 && x >= 10 && x < 70, spark = x == 80 && y == 20;
      const float level = spark ? 1e4F : lamp ? 50.0F : pane ? 100.0F + 5.0F * static_cast<float>(x % 7) : 1e-4F;
      rgb.at(x, y, 0) = level;
      rgb.at(x, y, 1) = (pane && x < 32 ? 0.1F : 0.7F) * level;
      rgb.at(x, y, 2) = (pane && x > 44 ? 0.9F : 0.3F) * level;
    }
  }
  return picture_of(rgb);
}

// A single wavelength, whose light has the same sign in all channels: spectral colours outside the gamut are negative
// in one.
TEST_CASE("a photograph's flare lowers no channel") {
  const Picture picture = picture_of_window();
  struct Case {
    const char *lens, *max_light_count;
  };
  for (const Case& c : {Case{"heliar", "16"}, Case{"heliar", "1"}, Case{"schneider-anamorphic-31", "1"}}) {
    CAPTURE(c.lens);
    const auto lens = configure_lens(find_lens(c.lens).value(), {.f_number = 8.0, .iris = {6}});
    REQUIRE(lens.has_value());
    const Values values = values_of({{"threshold", "2"},
                                     {"max-lights", c.max_light_count},
                                     {"starburst", "on"},
                                     {"glare", "0.05"},
                                     {"gain", "100"},
                                     {"ghosts", "all"},
                                     {"wavelengths", "1"},
                                     {"select", "surface:3"}});
    const Image flare = applied(picture, *lens, values).flare;
    const auto [low, high] = std::ranges::minmax(flare.pixels);
    CHECK(high > 0.0F);
    CHECK(low >= 0.0F);
  }
}

TEST_CASE("two lights merged for the ghosts keep their starbursts at their places") {
  const LensState lens = planar();
  Image rgb(kWidth, kHeight);
  for (const int x : {20, 70})
    for (int c = 0; c < 3; ++c) rgb.at(x, 30, c) = 1000.0F;
  const Picture picture = picture_of(rgb);
  const Values values =
      values_of({{"threshold", "2"}, {"max-lights", "1"}, {"starburst", "on"}, {"select", "list:1-2"}});
  const auto plan = plan_flare(picture, lens, values);
  REQUIRE(plan.has_value());
  CHECK(plan->lights.size() == 1);
  REQUIRE(plan->imaged_lights);
  CHECK(plan->imaged_lights->size() == 2);
  const Image flare = applied(picture, lens, values).flare;
  CHECK(flare.at(21, 30, 1) > 20.0F * flare.at(45, 30, 1));
  CHECK(flare.at(71, 30, 1) > 20.0F * flare.at(45, 30, 1));
}

TEST_CASE("a light's shape is its pixels, unless it is a point or shapes are off") {
  const LensState lens = planar();
  const auto light_of = [&](const Picture& picture, const char* on) {
    const auto plan = plan_flare(picture, lens, values_of({{"threshold", "2"}, {"light-shape", on}}));
    REQUIRE(plan.has_value());
    REQUIRE(plan->lights.size() == 1);
    return plan->lights[0];
  };
  CHECK(light_of(picture_of_disc(40.0, 30.0), "off").is_point());
  const Light disc = light_of(picture_of_disc(40.0, 30.0), "on");
  REQUIRE(disc.shape);
  // 36 mm over 96 pixels at 50 mm: a pixel is 0.0075.
  CHECK(length(disc.shape->right) == test::approx(0.0075).epsilon(0.05));
  CHECK(disc.shape->right.x > 0.0);
  CHECK(disc.shape->down.y < 0.0);
  Image rgb(kWidth, kHeight);
  for (int c = 0; c < 3; ++c) rgb.at(20, 30, c) = 1000.0F;
  CHECK(light_of(picture_of(rgb), "on").is_point());
}
