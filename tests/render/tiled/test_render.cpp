// SPDX-License-Identifier: Apache-2.0
// The whole renderer: contract, tiles, merging, interpolations, and against bundle.
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "render/bundle/bundle.h"
#include "render/tiled/scene.h"
#include "render/tiled/tiled.h"
#include "render/tiled/tiled_frame.h"
#include "support/approx.h"
#include "support/planned.h"

using namespace contrejour;
using test::settings_for;

namespace {

Flare tiled_of(const LensState& lens, std::span<const Light> lights, const test::Settings& settings,
               const Context& context = {}) {
  auto flare = test::render_alone(render_tiled, settings.tiled, lens, lights, settings, context);
  REQUIRE(flare.has_value());
  return *flare;
}

double psnr_db(const Image& truth, const Image& image) {
  const auto difference = compare(truth, image);
  REQUIRE(difference.has_value());
  return difference->psnr_db.value_or(1e9);
}

// A square picture, or its middle, about the axis.
test::Settings plate_settings(int pixels, double pixel_pitch_mm, int grid) {
  Frame frame;
  frame.width = frame.full_width = pixels;
  frame.height = frame.full_height = pixels;
  frame.pixel_pitch_mm = pixel_pitch_mm;
  test::Settings settings = test::green(frame);
  settings.set_grid(grid);
  return settings;
}

struct System {
  const char* name;
  double f_number, focal_length_mm;
  double bundle_db, light_db, heavy_db;  // the lowest PSNR: unmerged against bundle, and merged against unmerged
};

}  // namespace

TEST_CASE("the same bits for 1, 2 and 7 threads") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 160, 90, 48);
  settings.lambda_nm.clear();
  settings.wavelengths = 5;
  const std::vector<Light> lights{test::light_at(lens, settings.frame, {0.7, 0.33}),
                                  test::light_at(lens, settings.frame, {0.25, 0.75})};
  Context context;
  context.threads = 1;
  const Flare one = tiled_of(lens, lights, settings, context);
  for (const int threads : {2, 7}) {
    context.threads = threads;
    CHECK(tiled_of(lens, lights, settings, context).image.pixels == one.image.pixels);
  }
  const RenderStatistics& s = one.statistics;
  CHECK(s.ghosts_rendered == 13);
  CHECK(s.primitives > s.primitives_merged);
  CHECK(s.primitive_bytes == s.primitives_merged * sizeof(tiled::Primitive));
  CHECK(s.tile_list_bytes >= 4 * s.tile_indices);
  CHECK(s.time_ms.back().first == "total");
}

TEST_CASE("the same bits for any tiles, and however often the buffer is emptied") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 163, 91, 48);
  const Light light = test::light_at(lens, settings.frame, {0.7, 0.33});
  const Flare first = tiled_of(lens, {&light, 1}, settings);
  CHECK(test::sum(first.image) > 0.0);
  for (const auto& [dense, coarse] : {std::pair{8, 0}, std::pair{16, 128}, std::pair{16, 0}, std::pair{1, 4},
                                      std::pair{7, 35}, std::pair{200, 400}}) {
    settings.tiled.dense_tile = dense;
    settings.tiled.coarse_tile = coarse;
    CHECK(tiled_of(lens, {&light, 1}, settings).image.pixels == first.image.pixels);
  }

  const RayGrid grid = test::traced(lens, {3, 4}, light.direction, 64);
  settings.tiled = {};
  tiled::PrimitiveBuffer buffer;
  tiled::PrimitiveBuilder(settings.frame, settings.tiled).build(grid, {}, buffer);
  const IrisShape iris(lens.iris);
  const std::vector<tiled::Gain> gains{{1.0F, 2.0F, 3.0F}};
  const auto drawn = [&](const tiled::HeldLimits& limits) {
    tiled::TiledFrame frame(settings.frame, settings.tiled, {}, iris, gains, limits);
    frame.add(buffer);
    frame.draw();
    return frame.take_image().pixels;
  };
  CHECK(drawn({}) == drawn({7, 1000}));
  CHECK(drawn({}) == drawn({1000, 5}));
}

// Streaks some hundredths of a pixel wide had lain between all pixels' middles, or had given one pixel thirty times
// their light.
TEST_CASE("streaks thinner than a pixel keep their light") {
  const LensState lens = test::lens_at_f("schneider-anamorphic-31", 8.0);
  for (const int width : {120, 160, 240}) {
    CAPTURE(width);
    test::Settings settings = settings_for(lens, width, width * 9 / 16, 64);
    settings.selection = SelectList{{{1, 3}, {2, 3}, {3, 4}, {3, 6}}};
    settings.scope = GhostScope::All;
    const Light light = test::light_at(lens, settings.frame, {0.6, 0.3});
    const auto truth = test::render_alone(render_bundle, settings.bundle, lens, {&light, 1}, settings);
    REQUIRE(truth.has_value());
    const double ratio = test::sum(tiled_of(lens, {&light, 1}, settings).image) / test::sum(truth->image);
    CHECK(ratio == test::approx(1.0).epsilon(0.25));
  }
}

// Against bundle the error is that of one sample for each pixel: about 40 dB, whatever the grid.
TEST_CASE("against bundle on the same grid, and merged against unmerged") {
  for (const System& system :
       {System{"heliar", 16.0, 0.0, 39.5, 55.0, 53.0}, System{"tessar", 11.0, 0.0, 41.0, 48.0, 43.0},
        System{"itoh-zoom", 32.0, 123.0, 40.0, 53.0, 53.0}}) {
    CAPTURE(system.name);
    const LensState lens = test::lens_at_f(system.name, system.f_number, system.focal_length_mm);
    test::Settings settings = settings_for(lens, 320, 180, 96);
    const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
    const auto truth = test::render_alone(render_bundle, settings.bundle, lens, {&light, 1}, settings);
    REQUIRE(truth.has_value());
    settings.tiled.merge_steps = 0;
    const Flare unmerged = tiled_of(lens, {&light, 1}, settings);
    settings.tiled.merge_steps = 4;
    const Flare light_merge = tiled_of(lens, {&light, 1}, settings);
    settings.tiled.merge_threshold = 0.1;
    const Flare heavy_merge = tiled_of(lens, {&light, 1}, settings);
    CHECK(psnr_db(truth->image, unmerged.image) > system.bundle_db);
    CHECK(psnr_db(unmerged.image, light_merge.image) > system.light_db);
    CHECK(psnr_db(unmerged.image, heavy_merge.image) > system.heavy_db);
    CHECK(compare(truth->image, unmerged.image)->flux_ratio[0] == test::approx(1.0).epsilon(0.01));
    CHECK(light_merge.statistics.primitives_merged < unmerged.statistics.primitives_merged / 3);
    CHECK(heavy_merge.statistics.primitives_merged <= light_merge.statistics.primitives_merged);
  }
}

TEST_CASE("a large flat ghost has bundle's level, whatever the interpolation") {
  const LensState lens = test::plate();
  test::Settings settings = plate_settings(64, 0.15, 64);
  Light light;
  light.direction = normalized({0.02, 0.03, 1.0});
  const auto truth = test::render_alone(render_bundle, settings.bundle, lens, {&light, 1}, settings);
  REQUIRE(truth.has_value());
  using Interpolation = TiledOptions::Interpolation;
  for (const auto interpolation : {Interpolation::Triangle, Interpolation::HomogeneousTriangle,
                                   Interpolation::MeanValue, Interpolation::Wachspress, Interpolation::LoopDeRose}) {
    CAPTURE(static_cast<int>(interpolation));
    settings.tiled.interpolation = interpolation;
    const Flare flare = tiled_of(lens, {&light, 1}, settings);
    for (int y = 28; y < 36; ++y) {
      for (int x = 28; x < 36; ++x) {
        CHECK(flare.image.at(x, y) / truth->image.at(x, y) == test::approx(1.0).epsilon(1e-3));
      }
    }
    CHECK(test::sum(flare.image) / test::sum(truth->image) == test::approx(1.0).epsilon(5e-3));
  }
}

TEST_CASE("every interpolation makes nearly the same picture") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 160, 90, 64);
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const Flare usual = tiled_of(lens, {&light, 1}, settings);
  for (int k = 0; k < 5; ++k) {
    settings.tiled.interpolation = static_cast<TiledOptions::Interpolation>(k);
    CHECK(psnr_db(usual.image, tiled_of(lens, {&light, 1}, settings).image) > 55.0);
  }
}

TEST_CASE("paths that cross the stop three times, and an iris of blades") {
  LensSettings lens_settings;
  lens_settings.f_number = 8.0;
  lens_settings.iris.blades = 6;
  const LensState lens = test::bundled("heliar", lens_settings);
  test::Settings settings = settings_for(lens, 160, 90, 96);
  settings.scope = GhostScope::All;
  settings.selection = SelectList{{{3, 9}, {4, 8}, {2, 3}}};
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const auto truth = test::render_alone(render_bundle, settings.bundle, lens, {&light, 1}, settings);
  REQUIRE(truth.has_value());
  const Flare flare = tiled_of(lens, {&light, 1}, settings);
  CHECK(psnr_db(truth->image, flare.image) > 33.0);
  CHECK(compare(truth->image, flare.image)->flux_ratio[0] == test::approx(1.0).epsilon(0.03));
}

TEST_CASE("no light, no flare; one pixel, no trouble") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  CHECK(tiled_of(lens, {}, settings_for(lens, 32, 18, 32)).image.pixels == Pixels(32 * 18 * 3, 0.0F));
  const test::Settings settings = settings_for(lens, 1, 1, 32);
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const Flare flare = tiled_of(lens, {&light, 1}, settings);
  CHECK(flare.image.pixels.size() == 3);
  for (const float value : flare.image.pixels) CHECK(std::isfinite(value));
}

TEST_CASE("a picture symmetric about the axis counts no pixel twice") {
  // The middle ray and the middle pixel are on the axis: four cells meet there.
  const LensState lens = test::plate();
  test::Settings settings = plate_settings(33, 0.25, 65);
  const Light light;
  for (const int steps : {0, 4}) {
    settings.tiled.merge_steps = steps;
    const Flare flare = tiled_of(lens, {&light, 1}, settings);
    for (int k = 12; k < 21; ++k) {
      CHECK(flare.image.at(k, 16) / flare.image.at(13, 13) == test::approx(1.0).epsilon(0.01));
      CHECK(flare.image.at(16, k) / flare.image.at(13, 13) == test::approx(1.0).epsilon(0.01));
    }
  }
}

TEST_CASE("lights at grazing angles, fisheyes wide open") {
  for (const char* name : {"heliar", "muller-fisheye-10"}) {
    const LensState lens = test::bundled(name);
    const test::Settings settings = settings_for(lens, 32, 18, 32);
    for (const double angle_deg : {0.0, 40.0, 80.0, 89.0}) {
      Light light;
      light.direction = direction_from_angles(angle_deg * std::numbers::pi / 180.0, 0.0);
      for (const float value : tiled_of(lens, {&light, 1}, settings).image.pixels) CHECK(std::isfinite(value));
    }
  }
}

TEST_CASE("settings out of range are refused, a set cancel flag is obeyed") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Light light;
  const test::Settings good = settings_for(lens, 32, 18, 32);
  const auto refused = [&](auto change) {
    test::Settings settings = good;
    change(settings);
    const auto flare = test::render_alone(render_tiled, settings.tiled, lens, {&light, 1}, settings);
    return !flare.has_value() && flare.error().code == ErrorCode::InvalidArgument;
  };
  CHECK(refused([](test::Settings& s) { s.set_grid(3); }));
  CHECK(refused([](test::Settings& s) { s.tiled.merge_steps = -1; }));
  CHECK(refused([](test::Settings& s) { s.tiled.merge_threshold = std::numeric_limits<double>::quiet_NaN(); }));
  CHECK(refused([](test::Settings& s) { s.tiled.dense_tile = 0; }));
  CHECK(refused([](test::Settings& s) { s.tiled.dense_tile = 48; }));
  const std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  const auto stopped = test::render_alone(render_tiled, good.tiled, lens, {&light, 1}, good, context);
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::Cancelled);
}
