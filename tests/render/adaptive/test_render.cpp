// SPDX-License-Identifier: Apache-2.0
// The whole renderer's own properties; tests/render/all_methods checks what all renderers have in common.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>

#include <hwy/targets.h>

#include "contrejour/expert/metrics.h"
#include "contrejour/image_io.h"
#include "render/adaptive/scene.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/kept_picture.h"

using namespace contrejour;

namespace {

constexpr double kPresets[] = {0.01, 0.003, 0.001};  // preview, standard, final

test::Settings settings_for(const LensState& lens, int width, int height) {
  return test::green(frame_on_sensor(lens, width, height));
}

Image image_of(std::string_view method, const LensState& lens, const Light& light, const test::Settings& settings) {
  return test::flare_of(method, lens, {&light, 1}, settings).image;
}

double psnr_db(const Image& truth, const Image& image) {
  const auto difference = compare(truth, image);
  REQUIRE(difference.has_value());
  return difference->psnr_db.value_or(1000.0);
}

Rgb channel_sums(const Image& image) {
  Rgb sums{};
  for (std::size_t k = 0; k < image.pixels.size(); ++k) sums[k % 3] += image.pixels[k];
  return sums;
}

double peak_of(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

double largest_difference(const Image& a, const Image& b) {
  double worst = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k)
    worst = std::max(worst, std::abs(static_cast<double>(a.pixels[k]) - b.pixels[k]));
  return worst;
}

struct System {
  const char* name;
  LensSettings settings;
  Vec2 uv{0.70, 0.33};
  double standard_db = 50.0;  // at the default error
};

// For each of 100 steps of a hundredth of a pixel, the largest change of a pixel relative to the brightest.
std::vector<double> changes_of(const System& system) {
  constexpr int kSteps = 100;
  const LensState lens = test::bundled(system.name, system.settings);
  const test::Settings settings = settings_for(lens, 96, 64);
  std::vector<double> changes;
  Image before;
  for (int step = 0; step <= kSteps; ++step) {
    const Light light = test::light_at(lens, settings.frame, system.uv + Vec2{0.01 * step / 96, 0.0});
    Image after = image_of("adaptive", lens, light, settings);
    if (step > 0) changes.push_back(largest_difference(before, after) / peak_of(after));
    before = std::move(after);
  }
  std::sort(changes.begin(), changes.end());
  return changes;
}

}  // namespace

// Systems that tests/render/all_methods does not have: other f-numbers, other points of the light, all presets.
TEST_CASE("closer to the reference with every preset, within its error or 50 dB of it [slow]") {
  for (const System& system :
       {System{"heliar", {.f_number = 16.0}, {0.62, 0.3}}, System{"heliar", {.f_number = 5.6}, {0.2, 0.71}},
        System{"planar-50", {.f_number = 5.6}, {0.35, 0.4}},
        // Ghosts (1, 4) and (3, 5) come through islands among rays that fail; 46 dB without them.
        System{"muller-fisheye-10", {.f_number = 16.0}, {0.8, 0.5}, 58.0}}) {
    CAPTURE(system.name);
    const LensState lens = test::bundled(system.name, system.settings);
    test::Settings settings = settings_for(lens, 160, 90);
    const Light light = test::light_at(lens, settings.frame, system.uv);
    const std::string kept = std::string(system.name) + (system.settings.f_number < 8.0 ? "-wide" : "-closed");
    const Image truth = test::kept_picture(kept, [&] { return image_of("reference", lens, light, settings); });
    double before_db = 0.0;
    for (const double error : kPresets) {
      CAPTURE(error);
      settings.set_error(error);
      const double db = psnr_db(truth, image_of("adaptive", lens, light, settings));
      CHECK(db >= before_db - 0.1);  // the reference's own error shows from 64 dB on
      CHECK(db >= std::min(50.0, -20.0 * std::log10(error)));
      if (error <= 0.003) CHECK(db >= system.standard_db);
      before_db = db;
    }
  }
}

// By the rule that distributes the error, the ghosts of a few lenses make all of it, those of others a tenth
// (docs/physics/adaptive.md).
TEST_CASE("frames taken at random are within the error asked for, all but a few [slow]") {
  constexpr int kFrames = 48;
  std::mt19937 random(11);
  const auto anywhere = [&] { return 1.2 * random() / 4294967296.0 - 0.1; };
  std::vector<double> over_asked;
  for (int k = 0; k < kFrames; ++k) {
    constexpr std::array kLenses{"heliar",     "planar-50", "tessar", "distagon-25", "angenieux-double-gauss",
                                 "canon-rf-50"};
    constexpr std::array kStops{5.6, 8.0, 11.0, 16.0, 22.0};
    const char* const name = kLenses[random() % kLenses.size()];
    const LensState lens = test::lens_at_f(name, kStops[random() % kStops.size()]);
    const int width = 96 << random() % 2U;
    test::Settings settings = settings_for(lens, width, width * 9 / 16);
    settings.lambda_nm.clear();
    settings.wavelengths = 1 + 2 * static_cast<int>(random() % 2U);
    const double u = anywhere();
    const Light light = test::light_at(lens, settings.frame, {u, anywhere()});
    const Image image = image_of("adaptive", lens, light, settings);
    const double asked = settings.adaptive.error;
    settings.set_error(1e-4);
    const auto off = compare(image_of("adaptive", lens, light, settings), image);
    REQUIRE(off.has_value());
    over_asked.push_back(std::pow(10.0, -off->psnr_db.value_or(1000.0) / 20.0) / asked);
  }
  std::sort(over_asked.begin(), over_asked.end());
  CHECK(over_asked[kFrames / 2] < 0.3);
  CHECK(over_asked[kFrames * 9 / 10] < 0.6);
  CHECK(over_asked.back() < 1.2);
}

TEST_CASE("ghosts that fall outside the frame leave it dark") {
  const LensState lens = test::lens_at_f("nikon-80-200", 16.0, 140.0);
  test::Settings settings = settings_for(lens, 480, 270);
  settings.lambda_nm.clear();
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  for (const Ghost ghost : {Ghost{13, 17}, Ghost{1, 10}, Ghost{5, 7}, Ghost{6, 19}, Ghost{14, 15}}) {
    CAPTURE(ghost.i);
    CAPTURE(ghost.j);
    settings.selection = SelectList{{ghost}};
    const Image image = image_of("adaptive", lens, light, settings);
    const Image coarse = image_of("bundle", lens, light, settings);
    CHECK(peak_of(image) <= 2.0 * peak_of(coarse));
  }
}

// The reference takes many minutes here; tests/render/all_methods compares the bundle with it.
TEST_CASE("the Canon at 200 mm wide open, its brightest ghosts, as by the bundle [slow]") {
  const LensState lens = test::lens_at_f("canon-70-200", 2.8, 200.0);
  test::Settings settings = settings_for(lens, 96, 54);
  settings.selection = SelectBrightest{24};
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const Image truth = image_of("bundle", lens, light, settings);
  const Image image = image_of("adaptive", lens, light, settings);
  CHECK(psnr_db(truth, image) >= 50.0);
  CHECK(test::sum(image) / test::sum(truth) == test::approx(1.0).epsilon(0.005));
}

TEST_CASE("sixteen wavelengths as by the bundle, the same bits for 1, 2 and 7 threads") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 96, 64);
  settings.lambda_nm.clear();
  settings.wavelengths = 16;
  settings.set_grid(128);
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const Image truth = image_of("bundle", lens, light, settings);
  const Image one = test::flare_of("adaptive", lens, {&light, 1}, settings, {.threads = 1}).image;
  CHECK(psnr_db(truth, one) >= 50.0);
  for (const int threads : {2, 7}) {
    CHECK(test::flare_of("adaptive", lens, {&light, 1}, settings, {.threads = threads}).image.pixels == one.pixels);
  }
}

TEST_CASE("every pair of surfaces, an iris of blades, lights on the axis and off it, as by the bundle") {
  const LensState lens = test::lens_at_f("heliar", 8.0, 0.0, {7, 0.4});
  test::Settings settings = settings_for(lens, 96, 64);
  settings.set_grid(256);
  for (const GhostScope scope : {GhostScope::OneSideOfStop, GhostScope::All}) {
    settings.scope = scope;
    for (const Vec2 uv : {Vec2{0.5, 0.5}, Vec2{0.31, 0.62}}) {
      CAPTURE(uv.x);
      Light light = test::light_at(lens, settings.frame, uv);
      if (uv.x == 0.5) light.direction = {0.0, 0.0, 1.0};
      const Image truth = image_of("bundle", lens, light, settings);
      const Image image = image_of("adaptive", lens, light, settings);
      CHECK(psnr_db(truth, image) >= 50.0);
      CHECK(test::sum(image) / test::sum(truth) == test::approx(1.0).epsilon(0.005));
    }
  }
}

TEST_CASE("an animation of a hundred small steps of the light has no jumps [slow]") {
  for (const System& system : {System{"heliar", {.f_number = 8.0}}, System{"heliar", {.f_number = 16.0}, {0.4, 0.3}},
                               System{"planar-50", {.f_number = 2.8}}}) {
    CAPTURE(system.name);
    const auto changes = changes_of(system);
    const double median = changes[changes.size() / 2];
    CHECK(median > 0.0);
    CHECK(changes.back() <= 0.04);
    CHECK(changes.back() <= 4.0 * median);
  }
}

TEST_CASE("frames of one pixel, of one row, of one column") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  Frame whole = frame_on_sensor(lens, 90, 60);
  const Light light = test::light_at(lens, whole, {0.70, 0.33});
  test::Settings settings = settings_for(lens, 90, 60);
  const double all = test::sum(image_of("adaptive", lens, light, settings));
  struct Size {
    int width, height;
  };
  for (const Size& size : {Size{1, 1}, Size{1500, 1}, Size{1, 700}}) {
    CAPTURE(size.width);
    Frame frame = whole;
    frame.width = frame.full_width = size.width;
    frame.height = frame.full_height = size.height;
    settings.frame = frame;
    const Image image = image_of("adaptive", lens, light, settings);
    CHECK(image.pixels.size() == static_cast<std::size_t>(3 * size.width * size.height));
    CHECK(*std::min_element(image.pixels.begin(), image.pixels.end()) >= -1e-6 * peak_of(image));
  }
  // A frame that is one row of the whole frame must equal that row.
  settings.frame = whole;
  settings.frame.origin_y = 30;
  settings.frame.height = 1;
  const Image row = image_of("adaptive", lens, light, settings);
  settings.frame = whole;
  const Image image = image_of("adaptive", lens, light, settings);
  CHECK(all == test::sum(image));
  double worst = 0.0;
  for (int x = 0; x < 90; ++x)
    worst = std::max(worst, std::abs(static_cast<double>(row.at(x, 0, 1)) - image.at(x, 30, 1)));
  CHECK(worst <= 5e-3 * peak_of(image));
}

TEST_CASE("errors out of range are refused, no light is no flare, an interrupted render says so") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 32, 18);
  const Light light;
  for (const double error :
       {0.0, -0.01, 0.9e-4, 0.11, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    settings.set_error(error);
    const auto refused = render("adaptive", lens, {&light, 1}, settings);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::InvalidArgument);
  }
  for (const double error : {1e-4, 0.1}) {
    settings.set_error(error);
    CHECK(render("adaptive", lens, {&light, 1}, settings).has_value());
  }
  CHECK(test::flare_of("adaptive", lens, {}, settings).image.pixels == Pixels(32 * 18 * 3, 0.0F));
  std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  const auto stopped = render("adaptive", lens, {&light, 1}, settings, context);
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::Cancelled);
}

TEST_CASE("every instruction set of this machine draws the same, with fringes, too") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 523, 40);
  settings.wavelengths = 3;
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  for (const RingingMode mode : {RingingMode::None, RingingMode::Fresnel}) {
    settings.ringing.mode = mode;
    hwy::SetSupportedTargetsForTest(0);
    const Image best = image_of("adaptive", lens, light, settings);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      CAPTURE(hwy::TargetName(target));
      // Rounding decides here and there whether a cell is drawn whole or in parts, well within the error of 0.003.
      CHECK(psnr_db(best, image_of("adaptive", lens, light, settings)) > 75.0);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("a ghost alone, of which the preview shows nothing") {
  const LensState lens = test::bundled("tessar", {.f_number = 11.0});
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 240, 160);
  settings.reference.density = 0.25;
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  for (const Ghost ghost : {Ghost{2, 4}, Ghost{6, 7}}) {
    settings.selection = SelectList{{ghost}};
    const double ours = test::sum(test::flare_of("adaptive", lens, {&light, 1}, settings).image);
    const double truth = test::sum(test::flare_of("reference", lens, {&light, 1}, settings).image);
    CHECK(truth > 0.0);
    CHECK(ours == test::approx(truth).epsilon(0.01));
  }
}

TEST_CASE("a ghost in focus lies in its pixels, however far it exceeds the peak") {
  // A spot of 0.5 x 0.3 pixels, 30 times as bright as the peak of the other ghosts, crosses from pixel to pixel. A
  // tenth of its light was in the wrong one.
  const LensState lens = test::bundled("itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0});
  test::Settings settings;
  settings.wavelengths = 32;
  settings.frame = frame_on_sensor(lens, 320, 180);
  settings.scope = GhostScope::OneSideOfStop;
  for (const double moved_px : {15.0, 15.1, 15.2}) {
    CAPTURE(moved_px);
    const Light light = test::light_at(lens, settings.frame,
                                       {0.70 + moved_px * std::cos(0.3) / 320, 0.33 + moved_px * std::sin(0.3) / 180});
    settings.set_grid(96);
    settings.selection = SelectList{{{1, 3}}};
    const Image spot = test::flare_of("bundle", lens, {&light, 1}, settings).image;
    settings.selection = SelectAll{};
    const Image all = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
    const double whole = channel_sums(spot)[2];
    const std::size_t brightest = static_cast<std::size_t>(std::ranges::max_element(spot.pixels) - spot.pixels.begin());
    const int x = static_cast<int>(brightest / 3) % 320, y = static_cast<int>(brightest / 3) / 320;
    CHECK(whole > 20.0 * quantile_of_samples(all, 0.999));
    for (const int dy : {-1, 0, 1})
      for (const int dx : {-1, 0, 1}) {
        const double off = static_cast<double>(all.at(x + dx, y + dy, 2)) - spot.at(x + dx, y + dy, 2);
        CHECK(std::abs(off) < 0.06 * whole);
      }
  }
}

TEST_CASE("streaks of an anamorphic lens, thinner than a pixel, are as even as by the reference") {
  const LensState lens = test::bundled("schneider-anamorphic-31", {.f_number = 8.0});
  const Light light{.direction = direction_from_angles(0.11, 0.06)};
  test::Settings settings;
  settings.wavelengths = 3;
  settings.selection = SelectList{{{4, 6}}};
  settings.frame = frame_on_sensor(lens, 64, 36);
  settings.set_grid(256);
  const Image truth = image_of("reference", lens, light, settings);
  settings.set_error(0.0003);
  CHECK(psnr_db(truth, image_of("adaptive", lens, light, settings)) > 56.0);  // 44 with points for lines
}

TEST_CASE("a ghost nearly in focus keeps its light, however few pixels it is [slow]") {
  const LensState lens = test::bundled("itoh-zoom", {.f_number = 32.0, .iris = {7}});
  const Light light{.direction = normalized(Vec3{-0.295885, -0.285027, 0.911708})};
  test::Settings settings;
  settings.wavelengths = 3;
  settings.selection = SelectList{{{1, 3}}};
  settings.set_grid(512);
  for (const RingingMode ringing : {RingingMode::None, RingingMode::Fresnel}) {
    settings.ringing.mode = ringing;
    for (const int width : {640, 960, 1280, 1920}) {
      settings.frame = frame_on_sensor(lens, width, width * 9 / 16);
      const auto truth = channel_sums(test::flare_of("bundle", lens, {&light, 1}, settings).image);
      for (const double error : kPresets) {
        CAPTURE(width);
        CAPTURE(error);
        settings.set_error(error);
        const auto ours = channel_sums(test::flare_of("adaptive", lens, {&light, 1}, settings).image);
        for (const std::size_t c : {0U, 2U})  // little green light, less than the colours of red and blue leave
          CHECK(ours[c] / truth[c] == test::approx(1.0).epsilon(ringing == RingingMode::None ? 0.003 : 0.025));
      }
    }
  }
}

TEST_CASE("ringing of a ghost alone comes to the truth as the error falls, whatever makes it [slow]") {
  // Cases: fringes as fine as pixels, of patterns and of edges; a ghost of five pixels, whose cells are smaller than
  // one.
  struct Case {
    const char* lens;
    LensSettings settings;
    Vec2 uv;
    RingingMode mode;
    Ghost ghost;
    int width, height;
  };
  const Case cases[] = {
      {"distagon-25", {.f_number = 11.0, .iris = {5}}, {0.28, 0.22}, RingingMode::Hullin, {13, 16}, 192, 108},
      {"cooke-triplet", {.f_number = 22.0, .iris = {9}}, {0.40, 0.58}, RingingMode::Fresnel, {2, 3}, 192, 108},
      {"canon-70-200", {.f_number = 32.0, .iris = {5}}, {0.58, 0.24}, RingingMode::Hullin, {9, 19}, 192, 108}};
  for (const Case& of : cases) {
    CAPTURE(of.lens);
    const LensState lens = test::bundled(of.lens, of.settings);
    test::Settings settings = settings_for(lens, of.width, of.height);
    settings.ringing.mode = of.mode;
    settings.selection = SelectList{{of.ghost}};
    settings.reference.density = 2.0;
    const Light light = test::light_at(lens, settings.frame, of.uv);
    const Image truth = image_of("reference", lens, light, settings);
    settings.set_error(0.003);
    CHECK(psnr_db(truth, image_of("adaptive", lens, light, settings)) > 45.0);
    settings.set_error(0.0003);
    CHECK(psnr_db(truth, image_of("adaptive", lens, light, settings)) > 57.0);
  }
}

TEST_CASE("ghosts whose pupils end where rays fail keep their light") {
  // A frame of 160 degrees: the rays at this end are refracted steeply, and their distance on the sensor changes as a
  // square root.
  const LensState lens = test::bundled("planar-50");
  const Light light{.direction = normalized(Vec3{0.142665, 0.060187, 0.987940})};
  test::Settings settings;
  settings.wavelengths = 1;
  settings.frame = frame_on_sensor(lens, 160, 90);
  settings.frame.pixel_pitch_mm = 2.0 * lens.focal_length_mm * std::tan(1.396263) / 160.0;
  for (const auto& [ghost, part] : {std::pair{Ghost{8, 12}, 0.01}, {Ghost{10, 12}, 0.025}}) {
    settings.selection = SelectList{{ghost}};
    const double truth = test::sum(image_of("bundle", lens, light, settings));
    CHECK(test::sum(image_of("adaptive", lens, light, settings)) / truth == test::approx(1.0).epsilon(part));
  }
}

TEST_CASE("a caustic next to rays that fail has no streaks, and comes to the truth as the error falls") {
  const LensState lens = test::bundled("heliar", {.f_number = 3.5});
  test::Settings settings = settings_for(lens, 320, 180);
  settings.selection = SelectList{{{1, 9}}};
  settings.set_grid(512);
  const Vec2 at_px{0.7 * 320.0, 0.35 * 180.0};
  const Light light{
      .direction = direction_for_image_point(lens, settings.frame.sensor_from_pixel(at_px), lens.design_wavelength_nm)};
  const Image truth = image_of("bundle", lens, light, settings);
  settings.set_error(0.003);
  CHECK(psnr_db(truth, image_of("adaptive", lens, light, settings)) > 53.5);
  settings.set_error(0.0003);
  CHECK(psnr_db(truth, image_of("adaptive", lens, light, settings)) > 62.0);  // 55 with the rays of the first step
}

TEST_CASE("the outline of a dim ghost lies where a finer one does, with no corners") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings = settings_for(lens, 1920, 1080);
  settings.wavelengths = 3;
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  // Down some columns, the rows where the light of the topmost ghost begins, which is a hundredth as bright as the
  // peak.
  const auto outline = [&](double error) {
    settings.set_error(error);
    const Image image = image_of("adaptive", lens, light, settings);
    std::vector<double> rows;
    for (int x = 430; x < 860; ++x) {
      const auto level = static_cast<double>(image.at(x, 120, 2));
      int y = 1;
      while (y < 120 && image.at(x, y, 2) < 0.5 * level) ++y;
      const double before = image.at(x, y - 1, 2), here = image.at(x, y, 2);
      rows.push_back(y - (here - 0.5 * level) / std::max(here - before, 1e-30));
    }
    return rows;
  };
  const std::vector<double> plain = outline(0.003), fine = outline(1e-4);
  double max_off = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) max_off = std::max(max_off, std::abs(plain[k] - fine[k]));
  CHECK(max_off < 1.2);  // pixels
}
