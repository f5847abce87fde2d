// SPDX-License-Identifier: Apache-2.0
// What a small preview frame predicts of the whole one before anything is drawn at full quality.
#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "render/adaptive/adaptive.h"
#include "render/adaptive/item.h"
#include "render/adaptive/scene.h"
#include "render/planning/frame_plan.h"
#include "support/approx.h"
#include "support/flares.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

struct ItemSystem {
  const char* name;
  double f_number, focal_length_mm;
  Vec2 uv;
};

PreviewFrame preview_frame(const LensState& lens, const Light& light, const test::Settings& settings) {
  RenderCache cache;
  const auto plan = plan_frame({lens, {&light, 1}, settings, cache}, {});
  REQUIRE(plan.has_value());
  const StepsByWavelength steps(lens, plan->tables);
  const Scene scene{lens, *plan, std::move(steps), IrisShape(lens.iris)};
  Work work;
  const std::vector<Item> items = find_items(scene, {}, work);
  Pool<BoxCells> scratch_pool;
  TileRasteriser rasteriser;
  return draw_preview(scene, items, settings.frame, scratch_pool, rasteriser, {}, work);
}

}  // namespace

// The front of a fisheye bulges: the window of a light far off the axis reaches beyond the rim, to its side.
TEST_CASE("where around the axis a light stands changes nothing of where its rays are looked for") {
  const LensState lens = test::lens_at_f("muller-fisheye-10", 8.0, 0.0);
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 64, 36);
  const auto items_for = [&](double rotation) {
    Light light;
    light.direction = normalized(Vec3{2.5 * std::cos(rotation), 2.5 * std::sin(rotation), 1.0});
    RenderCache cache;
    const auto plan = plan_frame({lens, {&light, 1}, settings, cache}, {});
    REQUIRE(plan.has_value());
    const StepsByWavelength steps(lens, plan->tables);
    Work work;
    std::vector<Rectangle> found;
    for (const Item& item : find_items({lens, *plan, std::move(steps), IrisShape(lens.iris)}, {}, work)) {
      found.push_back({item.window.min_mm, item.window.max_mm});
      found.insert(found.end(), item.boxes.begin(), item.boxes.end());
    }
    return found;
  };
  const std::vector<Rectangle> along_x = items_for(0.0), aside = items_for(0.8);
  REQUIRE(along_x.size() == aside.size());
  for (std::size_t k = 0; k < aside.size(); ++k) {
    CHECK(length(aside[k].low - along_x[k].low) < 1e-3);
    CHECK(length(aside[k].high - along_x[k].high) < 1e-3);
  }
}

TEST_CASE("a plan that lets dark parts be left out gets the rest, as it is in the whole picture") {
  const LensState lens = test::lens_at_f("itoh-zoom", 32.0, 123.0);
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 320, 180);
  const Light light = test::light_at(lens, settings.frame, {0.7, 0.33});
  RenderCache cache;
  auto plan = plan_frame({lens, {&light, 1}, settings, cache}, {});
  REQUIRE(plan.has_value());
  const auto drawn = [&](std::vector<Ghost> ghosts, std::optional<int> margin_px) {
    FramePlan part = *plan;
    part.adjustments.resize(ghosts.size());
    part.ghosts = std::move(ghosts);
    part.dark_margin_px = margin_px;
    RenderCache own_cache;
    auto flare = render_adaptive({lens, part, settings, own_cache}, {}, {});
    REQUIRE(flare.has_value());
    return std::move(flare->picture);
  };
  int smaller = 0, dark = 0;
  for (const Ghost& ghost : plan->ghosts) {
    const DrawnImage whole = drawn({ghost}, std::nullopt), part = drawn({ghost}, 5);
    REQUIRE((whole.image.width == 320 && whole.image.height == 180));
    CHECK((whole.left == 0 && whole.top == 0));
    smaller += part.image.pixels.size() < whole.image.pixels.size() ? 1 : 0;
    dark += part.image.pixels.empty() ? 1 : 0;
    Image all(320, 180);
    for (int y = 0; y < part.image.height; ++y) std::ranges::copy(part.image.row(y), &all.at(part.left, part.top + y));
    CHECK(all.pixels == whole.image.pixels);
  }
  CHECK(smaller > 10);
  CHECK(dark > 0);
  CHECK(drawn({}, 5).image.pixels.empty());
}

TEST_CASE("a picture that is a part of a frame may make a part of the squared error") {
  const LensState lens = test::lens_at_f("tessar", 11.0);
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 96, 64);
  const Light light = test::light_at(lens, settings.frame, {0.7, 0.33});
  RenderCache cache;
  auto plan = plan_frame({lens, {&light, 1}, settings, cache}, {});
  REQUIRE(plan.has_value());
  const auto drawn = [&](double error, double fraction) {
    FramePlan part = *plan;
    part.error_fraction = fraction;
    RenderCache own_cache;
    AdaptiveOptions options;
    options.error = error;
    auto flare = render_adaptive({lens, part, settings, own_cache}, options, {});
    REQUIRE(flare.has_value());
    return std::move(flare->picture.image.pixels);
  };
  const auto finer = drawn(0.002, 1.0);
  CHECK(drawn(0.004, 0.25) == finer);
  CHECK(drawn(0.004, 1.0) != finer);
}

TEST_CASE("the preview tells the level of a ghost that is smaller than its pixels") {
  const LensState lens = test::lens_at_f("itoh-zoom", 32.0, 123.0);
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 320, 180);
  settings.selection = SelectList{{{1, 3}}};
  const Light light = test::light_at(lens, settings.frame, {0.7, 0.33});
  const auto estimates = preview_frame(lens, light, settings).estimates;
  REQUIRE(estimates.size() == 1);
  const auto image = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
  double largest = 0.0;
  for (const float value : image.pixels) largest = std::max(largest, static_cast<double>(value));
  CHECK(estimates.front().area_px == test::approx(1.0));
  CHECK(estimates.front().level > 0.4 * largest);  // of one channel; the level is the RMS of all
  CHECK(estimates.front().level < 1.2 * largest);
}

// Coatings reflect the middle wavelength least: with its light in place of all, the peak would be a third of the true
// one.
TEST_CASE("the peak that errors are relative to is the picture's, whatever its size and wavelengths [slow]") {
  for (const ItemSystem& system :
       {ItemSystem{"heliar", 16.0, 0.0, {0.7, 0.33}}, ItemSystem{"itoh-zoom", 32.0, 123.0, {0.7, 0.33}},
        ItemSystem{"nikon-80-200", 16.0, 140.0, {0.25, 0.75}}, ItemSystem{"canon-70-200", 32.0, 135.0, {0.7, 0.33}},
        ItemSystem{"planar-50", 11.0, 0.0, {0.3, 0.8}}}) {
    const LensState lens = test::lens_at_f(system.name, system.f_number, system.focal_length_mm);
    for (const int width : {160, 640}) {
      for (const int wavelengths : {3, 8}) {
        CAPTURE(system.name);
        CAPTURE(width);
        CAPTURE(wavelengths);
        test::Settings settings;
        settings.frame = frame_on_sensor(lens, width, width * 9 / 16);
        settings.wavelengths = wavelengths;
        const Light light = test::light_at(lens, settings.frame, system.uv);
        const Image image = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
        const double peak = quantile_of_samples(image, 0.999);
        const double preview = preview_frame(lens, light, settings).peak / peak;
        CHECK(preview > 0.6);
        CHECK(preview < 2.0);
      }
    }
  }
}
