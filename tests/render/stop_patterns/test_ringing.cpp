// SPDX-License-Identifier: Apache-2.0
// Ringing in pictures: the positions of the fringes, the flux, and the agreement of all methods.
#include <cmath>
#include <memory>
#include <numbers>

#include "render/all_methods/methods.h"
#include "render/session/render_frame.h"
#include "render/stop_patterns/dirt_fringes.h"
#include "render/stop_patterns/stop_patterns.h"
#include "support/approx.h"
#include "support/pictures.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

constexpr double kPlateRadius_mm = 3.0;
constexpr double kPlateFlux = 0.04 * 0.04;  // of the light's value

test::Settings ringing(test::Settings settings, RingingMode mode = RingingMode::Fresnel) {
  settings.ringing.mode = mode;
  return settings;
}

// A stop of another radius: F = a^2 / (550 nm * 12 mm).
LensState plate_of(double radius_mm, const Iris& iris) {
  LensState lens = plate();
  lens.stop_radius_mm = radius_mm;
  lens.iris = iris;
  return lens;
}

Frame square_frame(int side, double pitch_mm) { return {side, side, 0, 0, side, side, pitch_mm}; }

// The picture of a light on the axis, with a cache that earlier frames may have filled.
Image image_with(RenderCache& cache, std::string_view method, const LensState& lens, const Settings& settings,
                 int threads = 0) {
  Context context;
  context.threads = threads;
  const Light light;
  auto flare = render_frame(settings.options(method).value(), {lens, {&light, 1}, settings, cache}, context);
  REQUIRE(flare.has_value());
  return std::move(flare->image);
}

}  // namespace

TEST_CASE("behind a long edge the first fringe is 1.370, where the Fresnel integrals have it, inside the rim") {
  const Iris square{4, 0.25 * std::numbers::pi};
  const LensState lens = plate_of(kPlateRadius_mm, square);
  const double fringe_unit_px = kPlateRadius_mm / std::sqrt(2.0 * 9.0 / (550e-6 * 12.0)) / 0.01;
  const double edge_px = kPlateRadius_mm * std::sqrt(0.5) / 0.01;  // from the axis
  const double level = kPlateFlux * 1e-4 / (2.0 * 9.0);
  const test::Settings settings = ringing(green({90, 12, 300 + static_cast<int>(edge_px) - 60, 294, 600, 600, 0.01}));
  for_each_method([&](const Bounds& bounds) {
    test::Settings fine = settings;
    fine.set_error(1e-4);
    const Image image = image_of(bounds, lens, Light{}, fine);
    int best = 0;
    for (int x = 30; x < 90; ++x)
      if (image.at(x, 6) > image.at(best, 6)) best = x;
    CHECK(image.at(best, 6) / level == test::approx(1.370).epsilon(0.03));
    const double l = image.at(best - 1, 6), m = image.at(best, 6), r = image.at(best + 1, 6);
    const double position_px = settings.frame.origin_x - 300 + best + 0.5 + 0.5 * (l - r) / (l - 2.0 * m + r);
    CHECK((edge_px - position_px) / fringe_unit_px == test::approx(1.2172).epsilon(0.03));
    // A quarter of the level at the edge itself.
    const double at_edge = edge_px - (settings.frame.origin_x - 300) - 0.5;
    const int left = static_cast<int>(at_edge);
    const double value = std::lerp(image.at(left, 6), image.at(left + 1, 6), at_edge - left);
    CHECK(value / level == test::approx(0.25).epsilon(0.1));
  });
}

TEST_CASE("a ghost keeps its light, whatever its Fresnel number [slow]") {
  const Iris hexagon{6, 0.1};
  for (const double f : {0.2, 1.5, 20.0, 60.0, 1000.0}) {
    CAPTURE(f);
    const double radius_mm = std::sqrt(f * 550e-6 * 12.0);
    const LensState lens = plate_of(radius_mm, hexagon);
    const double half_mm = radius_mm * std::min(1.2 + 4.0 / std::sqrt(std::max(f, 0.5)) + 4.0 / std::max(f, 0.5), 12.5);
    const test::Settings settings = green(square_frame(128, half_mm / 64.0));
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_slow && f > 100.0) return;
      const double sharp = sum(image_of(bounds, lens, Light{}, settings));
      const double node = sum(image_of(bounds, lens, Light{}, ringing(settings)));
      CHECK(node / sharp == test::approx(1.0).epsilon(bounds.traits.integrates_pixels ? 0.015 : 0.04));
    });
  }
}

TEST_CASE("ghosts whose cells are larger than the iris have light nowhere else [slow]") {
  const LensState lens = bundled("itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0});
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 960, 540);
  settings.wavelengths = 3;
  const Light light = light_at(lens, settings.frame, {0.52, 0.55});
  for (const Ghost ghost : {Ghost{1, 2}, Ghost{14, 17}, Ghost{16, 18}, Ghost{17, 19}}) {
    CAPTURE(ghost.i);
    settings.selection = SelectList{{ghost}};
    const Image sharp = image_of(bounds_of("adaptive"), lens, light, settings);
    const Image node = image_of(bounds_of("adaptive"), lens, light, ringing(settings));
    CHECK(sum(node) / sum(sharp) == test::approx(1.0).epsilon(0.03));
  }
}

TEST_CASE("at a low Fresnel number a ghost widens smoothly and ends") {
  const double radius_mm = std::sqrt(1.5 * 550e-6 * 12.0);
  const LensState lens = plate_of(radius_mm, Iris{});
  const test::Settings settings = green(square_frame(160, 8.0 * radius_mm / 80.0));
  for_each_method([&](const Bounds& bounds) {
    const Image sharp = image_of(bounds, lens, Light{}, settings);
    const Image node = image_of(bounds, lens, Light{}, ringing(settings));
    double beyond = 0.0;
    for (int y = 0; y < 160; ++y) {
      for (int x = 0; x < 160; ++x) {
        const double r = std::hypot(x - 79.5, y - 79.5) / 10.0;  // stop radii
        if (r > 1.2) beyond += node.at(x, y);
        if (r > 5.6) CHECK(node.at(x, y) == 0.0F);
      }
    }
    CHECK(beyond / (sum(node) / 3.0) > 0.1);
    // 4 sin^2(pi F / 2) on the axis: 2 for F = 1.5 (Lommel).
    CHECK(node.at(80, 80) / sharp.at(80, 80) == test::approx(2.0).epsilon(0.16));
    CHECK(peak_of(node) < 2.6 * sharp.at(80, 80));
  });
}

TEST_CASE("methods agree [slow]") {
  const auto check = [](const char* kept, const LensState& lens, const Light& light, const test::Settings& settings) {
    const Image truth = kept_truth_of(kept, lens, light, settings);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_exact) return;
      test::Settings fine = settings;
      fine.set_error(1e-3);
      const Image image = image_of(bounds, lens, light, fine);
      CHECK(psnr_db(truth, image) >= (bounds.traits.integrates_pixels ? 42.0 : 28.0));
      CHECK(sum(image) / sum(truth) == test::approx(1.0).epsilon(bounds.traits.integrates_pixels ? 0.01 : 0.06));
    });
  };
  const Iris curved{5, 0.3, 0.4};
  for (const auto& [kept, f] :
       {std::pair{"plate-4", 4.0}, std::pair{"plate-30", 30.0}, std::pair{"plate-300", 300.0}}) {
    CAPTURE(f);
    const double radius_mm = std::sqrt(f * 550e-6 * 12.0);
    check(kept, plate_of(radius_mm, curved), Light{}, ringing(green(square_frame(64, radius_mm / 16.0))));
  }
  const LensState lens = bundled("heliar", {.f_number = 16.0, .iris = {7, 0.2}});
  test::Settings settings = small_frame(lens, 160, 107);
  settings.lambda_nm.clear();
  settings.reference.density = 0.7;
  check("heliar-ringing", lens, light_at(lens, settings.frame, {0.7, 0.33}), ringing(settings));
}

TEST_CASE("half-tones of a picture as the iris dim every point of a ghost, with fringes and without") {
  constexpr double kOpen = 0.9;  // stop radii
  const auto disc = [](Vec2 p) { return length(p) < kOpen ? 1.0 : 0.0; };
  const auto shaded = [](Vec2 p) { return length(p) < kOpen ? 0.6 + 0.4 * p.x : 0.0; };
  Iris plain, toned;
  plain.field = drawn_field(200, disc);
  toned.field = drawn_field(200, shaded);
  REQUIRE(toned.field->has_half_tones());
  struct Case {
    RingingMode mode;
    double fresnel_number;
  };
  for (const auto& [mode, f] :
       {Case{RingingMode::None, 300.0}, {RingingMode::Fresnel, 300.0}, {RingingMode::Fresnel, 30.0}}) {
    CAPTURE(f);
    const double radius_mm = std::sqrt(f * 550e-6 * 12.0);
    const test::Settings settings = ringing(green(square_frame(64, radius_mm / 16.0)), mode);
    for_each_method([&](const Bounds& bounds) {
      const Image bright = image_of(bounds, plate_of(radius_mm, plain), Light{}, settings);
      const Image dim = image_of(bounds, plate_of(radius_mm, toned), Light{}, settings);
      const double brightest = 0.6 + 0.4 * kOpen;  // of the picture, which counts as a transmittance of 1
      CHECK(sum(dim) / sum(bright) == test::approx(0.6 / brightest).epsilon(0.035));
      // The mean of x over a half disc is 4 r / (3 pi).
      const double off = 0.4 * 4.0 * kOpen / (3.0 * std::numbers::pi);
      double left = 0.0, right = 0.0;
      for (int y = 0; y < dim.height; ++y)
        for (int x = 0; x < dim.width; ++x) (2 * x < dim.width ? left : right) += dim.at(x, y);
      CHECK(std::min(left, right) / std::max(left, right) == test::approx((0.6 - off) / (0.6 + off)).epsilon(0.03));
    });
  }
}

TEST_CASE("every crossing but the last is sharp: ghosts that cross the stop three times agree, too") {
  const LensState lens = bundled("heliar", {.f_number = 22.0, .iris = {6, 0.2}});
  test::Settings settings = ringing(small_frame(lens, 120, 80));
  settings.scope = GhostScope::All;
  settings.selection = SelectList{{{2, 7}, {1, 9}}};
  const Light light = light_at(lens, settings.frame, {0.6, 0.4});
  settings.set_error(1e-3);
  const Image truth = truth_of(lens, light, settings);
  REQUIRE(sum(truth) > 0.0);
  for (const char* method : {"bundle", "adaptive"}) {
    CAPTURE(method);
    CHECK(psnr_db(truth, image_of(bounds_of(method), lens, light, settings)) > 34.0);
  }
}

TEST_CASE("off, order 0 and fringes finer than pixels give the sharp iris's bits") {
  const LensState lens = bundled("heliar", {.f_number = 8.0, .iris = {6, 0.2}});
  const test::Settings settings = small_frame(lens, 60, 40);
  const Light light = light_at(lens, settings.frame, {0.7, 0.33});
  const LensState plain = plate_of(kPlateRadius_mm, Iris{6, 0.2});
  const test::Settings coarse = green(square_frame(16, 0.6));
  for_each_method([&](const Bounds& bounds) {
    if (bounds.traits.is_exact) return;
    const auto expected = image_of(bounds, lens, light, settings).pixels;
    test::Settings off = settings;
    off.ringing = {RingingMode::None, 0.5};
    CHECK(image_of(bounds, lens, light, off).pixels == expected);
    test::Settings order_0 = ringing(settings, RingingMode::Hullin);
    for (const double alpha : {0.0, 1e-9, std::nan("")}) {
      order_0.ringing.alpha = alpha;
      CHECK(image_of(bounds, lens, light, order_0).pixels == expected);
    }
    CHECK(image_of(bounds, plain, Light{}, ringing(coarse)).pixels == image_of(bounds, plain, Light{}, coarse).pixels);
  });
}

TEST_CASE("the higher the Fresnel number, the closer to the sharp iris") {
  double before = 0.0;
  for (const double f : {10.0, 100.0, 1000.0, 10000.0}) {
    const double radius_mm = std::sqrt(f * 550e-6 * 12.0);
    const LensState lens = plate_of(radius_mm, Iris{6, 0.2});
    const test::Settings settings = green(square_frame(96, radius_mm / 36.0));
    const Bounds bundle = bounds_of("bundle");
    const double psnr =
        psnr_db(image_of(bundle, lens, Light{}, settings), image_of(bundle, lens, Light{}, ringing(settings)));
    CHECK(psnr > before + 1.0);
    before = psnr;
  }
}

TEST_CASE("hullin's pattern keeps the light and is the same for all ghosts") {
  const LensState lens = plate_of(0.6, Iris{6, 0.2});
  test::Settings settings = ringing(green(square_frame(96, 0.9 / 48.0)), RingingMode::Hullin);
  settings.ringing.alpha = 0.15;
  RenderCache cache;
  for (const char* method : {"bundle", "adaptive"}) {
    test::Settings sharp = settings;
    sharp.ringing.mode = RingingMode::None;
    const Image image = image_with(cache, method, lens, settings);
    CHECK(sum(image) / sum(image_of(bounds_of(method), lens, Light{}, sharp)) == test::approx(1.0).epsilon(0.01));
    CHECK(psnr_db(image_of(bounds_of(method), lens, Light{}, sharp), image) < 35.0);
  }
  CHECK(cache.find<stop_patterns::StopPatterns>()->count() == 1);
}

TEST_CASE("patterns that are kept change nothing, and go with their iris; threads change nothing") {
  const double radius_mm = std::sqrt(3.0 * 550e-6 * 12.0);
  const LensState lens = plate_of(radius_mm, Iris{6, 0.2}), other = plate_of(radius_mm, Iris{5, 0.2});
  const Settings settings = ringing(green(square_frame(48, radius_mm / 8.0)));
  for_each_method([&](const Bounds& bounds) {
    const auto fresh = [&](const LensState& with, int threads) {
      RenderCache cache;
      return image_with(cache, bounds.method, with, settings, threads).pixels;
    };
    const auto expected = fresh(lens, 1);
    CHECK(fresh(lens, 3) == expected);
    RenderCache cache;
    CHECK(cache.find<stop_patterns::StopPatterns>() == nullptr);
    CHECK(image_with(cache, bounds.method, lens, settings, 2).pixels == expected);
    const auto patterns = cache.find<stop_patterns::StopPatterns>();
    CHECK(patterns->count() == 2);  // for one wavelength, and for a band of that wavelength alone
    CHECK(image_with(cache, bounds.method, lens, settings, 2).pixels == expected);
    CHECK(cache.find<stop_patterns::StopPatterns>() == patterns);
    CHECK(patterns->count() == 2);
    CHECK(image_with(cache, bounds.method, other, settings, 2).pixels == fresh(other, 2));
    CHECK(cache.find<stop_patterns::StopPatterns>() != patterns);
    CHECK(image_with(cache, bounds.method, lens, settings, 2).pixels == expected);
  });
}

TEST_CASE("shadows of dirt that are kept change nothing, and go with their dirt") {
  LensState lens = plate_of(kPlateRadius_mm, Iris{6, 0.2});
  const Settings settings = ringing(green(square_frame(96, 0.05)));
  const auto fresh = [&] {
    RenderCache cache;
    return image_with(cache, "adaptive", lens, settings).pixels;
  };
  RenderCache cache;
  std::shared_ptr<const stop_patterns::DirtFringes> before;
  for (const std::uint32_t seed : {1U, 2U}) {
    lens.dirt = {.dust_per_cm2 = 40.0, .dust_mm = 0.3, .seed = seed};
    const auto expected = fresh();
    CHECK(image_with(cache, "adaptive", lens, settings).pixels == expected);
    const auto fringes = cache.find<stop_patterns::DirtFringes>();
    REQUIRE(fringes != nullptr);
    CHECK(fringes->count() > 0);
    CHECK(fringes != before);
    CHECK(image_with(cache, "adaptive", lens, settings).pixels == expected);
    CHECK(cache.find<stop_patterns::DirtFringes>() == fringes);
    before = fringes;
  }
}
