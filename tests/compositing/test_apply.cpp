// SPDX-License-Identifier: Apache-2.0
// Adds to a photograph the flare of its own lights, in memory.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/apply.h"
#include "contrejour/expert/settings.h"
#include "image/test_pictures.h"
#include "support/approx.h"

using namespace contrejour;
using params::Values;

namespace {

constexpr int kPlateWidth = 60, kPlateHeight = 40;

// A dark picture with one pixel at this multiple of white, and an alpha that differs from pixel to pixel.
Image rgba_with_light(int x, int y, float level) {
  Image rgba(kPlateWidth, kPlateHeight, 4);
  for (std::size_t k = 0; k < rgba.pixels.size(); ++k)
    rgba.pixels[k] = k % 4 == 3 ? static_cast<float>(k % 97) / 97.0F : 0.01F;
  for (int c = 0; c < 3; ++c) rgba.at(x, y, c) = level;
  return rgba;
}

Values apply_values(std::vector<std::pair<const char*, const char*>> given = {}) {
  Values values;
  for (const auto& [name, text] : given) REQUIRE(values.set(name, text).has_value());
  return values;
}

LensState heliar() {
  const auto state = configure_lens(find_lens("heliar").value(), {.f_number = 16.0});
  REQUIRE(state.has_value());
  return *state;
}

AppliedFlare must_apply(Picture& picture, const Values& values) {
  auto applied = apply_flare(picture, heliar(), values);
  REQUIRE_MESSAGE(applied.has_value(), (applied ? "" : applied.error().to_string()));
  return std::move(*applied);
}

double sum_of(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += value;
  return sum;
}

}  // namespace

TEST_CASE("a photograph gains its flare's flux, and no channel falls") {
  Picture picture = picture_of(rgba_with_light(40, 12, 5e5F));
  const Image before = picture.rgb;
  const AppliedFlare applied = must_apply(picture, apply_values());
  const Image& flare = applied.flare.image;
  REQUIRE(flare.pixels.size() == before.pixels.size());
  double flux = 0.0, gained = 0.0;
  for (std::size_t k = 0; k < before.pixels.size(); ++k) {
    CHECK(picture.rgb.pixels[k] >= before.pixels[k]);
    CHECK(picture.rgb.pixels[k] == before.pixels[k] + std::max(flare.pixels[k], 0.0F));
    flux += std::max(flare.pixels[k], 0.0F);
    gained += static_cast<double>(picture.rgb.pixels[k]) - before.pixels[k];
  }
  CHECK(flux > 1.0);
  CHECK(gained == test::approx(flux).epsilon(1e-4));  // floats of the light's own pixel are 0.03 apart
  REQUIRE(applied.plan.lights.size() == 1);
  CHECK(applied.plan.found.lights[0].centroid_px == Vec2{40.5, 12.5});
  CHECK(applied.flare.statistics.ghosts_rendered > 0);
  CHECK(applied.flare.visibility.stops_to_obvious.has_value());
}

TEST_CASE("flare follows its lights: twice the gain, twice the flux; another direction, another flare") {
  const auto flare_of = [](int x, const char* gain) {
    Picture picture = picture_of(rgba_with_light(x, 12, 5e5F));
    return must_apply(picture, apply_values({{"gain", gain}})).flare.image;
  };
  const Image once = flare_of(40, "1"), twice = flare_of(40, "2");
  for (std::size_t k = 0; k < once.pixels.size(); ++k) CHECK(twice.pixels[k] == 2.0F * once.pixels[k]);
  CHECK(flare_of(20, "1").pixels != once.pixels);
}

TEST_CASE("alpha, windows and channels of the file stay as they are") {
  Picture picture = picture_of(rgba_with_light(40, 12, 5e5F), SampleType::Half);
  picture.data_window = {-5, 9, kPlateWidth, kPlateHeight};
  picture.display_window = {0, 0, 80, 50};
  const Picture before = picture;
  must_apply(picture, apply_values());
  CHECK(picture.rgb.pixels != before.rgb.pixels);
  CHECK(picture.data_window == before.data_window);
  CHECK(picture.display_window == before.display_window);
  test::check_same_channels(before, picture);
}

TEST_CASE("a host's own RGBA pixels take the flare in colour alone") {
  const Image before = rgba_with_light(40, 12, 5e5F);
  Picture picture = picture_of(before);
  const AppliedFlare applied = must_apply(picture, apply_values());
  Image rgba = before;
  add_flare(rgba, applied.flare.image);
  for (int y = 0; y < rgba.height; ++y) {
    for (int x = 0; x < rgba.width; ++x) {
      for (int c = 0; c < 3; ++c) CHECK(rgba.at(x, y, c) == picture.rgb.at(x, y, c));
      CHECK(rgba.at(x, y, 3) == before.at(x, y, 3));
    }
  }
}

TEST_CASE("a flare takes nothing from a photograph, whatever its colour") {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Image photograph(2, 1), flare(2, 1), kept(2, 1);
  photograph.pixels = {0.5F, 0.0F, 1.0F, kInfinity, 0.25F, 0.5F};
  flare.pixels = {2.0F, -0.3F, -0.5F, 1.0F, 0.0F, 0.25F};
  kept.pixels = {2.5F, 0.0F, 1.0F, kInfinity, 0.25F, 0.75F};
  add_flare(photograph, flare);
  CHECK(photograph.pixels == kept.pixels);
}

TEST_CASE("a photograph without lights stays as it is") {
  Picture picture = picture_of(rgba_with_light(40, 12, 0.02F));
  picture.rgb.pixels[7] = std::numeric_limits<float>::infinity();
  const Image before = picture.rgb;
  const AppliedFlare applied = must_apply(picture, apply_values());
  CHECK(picture.rgb.pixels == before.pixels);
  CHECK(applied.plan.lights.empty());
  CHECK(applied.flare.image.width == kPlateWidth);
  CHECK(applied.flare.image.height == kPlateHeight);
  CHECK(sum_of(applied.flare.image) == 0.0);
  CHECK(applied.flare.statistics.ghosts_rendered == 0);
  CHECK_FALSE(applied.flare.visibility.stops_to_obvious.has_value());
}

TEST_CASE("pixels of twice the width: the flare is as large as the picture, and its flux the same") {
  Image square(kPlateWidth, kPlateHeight), wide(kPlateWidth / 2, kPlateHeight);
  for (int c = 0; c < 3; ++c) {
    square.at(40, 12, c) = square.at(41, 12, c) = 2.5e5F;
    wide.at(20, 12, c) = 5e5F;
  }
  Picture square_picture = picture_of(square), wide_picture = picture_of(wide);
  const Values values = apply_values({{"light-shape", "off"}, {"error", "final"}});
  const Values wide_values = apply_values({{"light-shape", "off"}, {"error", "final"}, {"pixel-aspect", "2"}});
  const Image fine = must_apply(square_picture, values).flare.image;
  const Image coarse = must_apply(wide_picture, wide_values).flare.image;
  CHECK(coarse.width == kPlateWidth / 2);
  CHECK(sum_of(coarse) == test::approx(sum_of(fine)).epsilon(1e-3));
}

TEST_CASE("a wrong input is refused and leaves the photograph as it was") {
  const auto refused = [](Picture picture, const Values& values, const Context& context = {}) {
    const Image before = picture.rgb;
    const auto applied = apply_flare(picture, heliar(), values, context);
    CHECK(picture.rgb.pixels == before.pixels);
    REQUIRE_FALSE(applied.has_value());
    return applied.error();
  };
  const Picture plate = picture_of(rgba_with_light(40, 12, 5e5F));
  Picture short_of_rows = plate;
  short_of_rows.rgb = Image(kPlateWidth, kPlateHeight - 1);
  CHECK(refused(short_of_rows, {}).message == "the picture's RGB pixels do not fill its data window");
  Picture of_four = plate;
  of_four.rgb = Image(kPlateWidth, kPlateHeight, 4);
  CHECK(refused(of_four, {}).code == ErrorCode::InvalidArgument);
  CHECK(refused(Picture{}, {}).code == ErrorCode::InvalidArgument);
  const Error silent = refused(plate, apply_values({{"light-at", "0.5,0.5"}}));
  CHECK(silent.message.find("does not say how bright") != std::string::npos);
  const std::atomic<bool> stopped = true;
  CHECK(refused(plate, {}, {.cancel = &stopped}).code == ErrorCode::Cancelled);
}

TEST_CASE("progress rises while the flare is rendered, and threads change nothing") {
  std::vector<double> progress;
  Picture alone = picture_of(rgba_with_light(40, 12, 5e5F)), shared = alone;
  const Context one{.threads = 1, .progress = [&](double done) { progress.push_back(done); }};
  REQUIRE(apply_flare(alone, heliar(), apply_values(), one).has_value());
  REQUIRE(apply_flare(shared, heliar(), apply_values(), {.threads = 3}).has_value());
  CHECK(alone.rgb.pixels == shared.rgb.pixels);
  REQUIRE_FALSE(progress.empty());
  CHECK(std::is_sorted(progress.begin(), progress.end()));
}

TEST_CASE("warnings tell what was assumed of the picture, unless the user said it") {
  const auto warnings = [](const Values& values) {
    const auto plan = plan_flare(picture_of(rgba_with_light(40, 12, 1e30F)), heliar(), values);
    REQUIRE(plan.has_value());
    return plan->warnings;
  };
  const std::vector<std::string> capped = warnings(apply_values());
  REQUIRE(capped.size() == 1);
  CHECK(capped[0] ==
        "pixels brighter than 1e+10 are clamped to it, and the picture has 1 of them; --max-value sets this limit");
  CHECK(warnings(apply_values({{"max-value", "1e6"}})).empty());
}

TEST_CASE("a flare that is not finite is no picture") {
  const auto grid = pixel_grid(Values{}, heliar(), {0, 0, 3, 2}, {0, 0, 3, 2}, 1.0);
  REQUIRE(grid.has_value());
  Image flare(3, 2);
  CHECK(picture_of_flare(flare, *grid).has_value());
  flare.pixels[4] = std::numeric_limits<float>::infinity();
  flare.pixels[5] = std::numeric_limits<float>::quiet_NaN();
  const auto refused = picture_of_flare(flare, *grid);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().message.starts_with("2 samples of the flare are not finite"));
}
