// SPDX-License-Identifier: Apache-2.0
// The same dirt in every renderer: shadows in ghosts, on the stop and on the front.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "render/all_methods/methods.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

constexpr double kPlateRadius_mm = 3.0;
constexpr int kSide = 80;

Dirt some_dirt(DirtPlane plane) {
  Dirt dirt;
  dirt.dust_per_cm2 = 60.0;
  dirt.dust_mm = 0.3;
  dirt.scratches_per_cm2 = 10.0;
  dirt.scratch_width_mm = 0.1;
  dirt.scratch_bend_rad = 0.8;
  dirt.plane = plane;
  dirt.seed = 5;
  return dirt;
}

// A picture of scratches all over a glass: a quarter of the stop, the upper right one, has a transmittance of a half.
std::shared_ptr<const DirtPicture> quarter_picture() {
  std::vector<float> level(64 * 64, 1.0F);
  for (std::size_t k = 0; k < level.size(); ++k)
    if (k % 64 >= 32 && k / 64 < 32) level[k] = 0.5F;
  const auto picture = DirtPicture::from_levels(level, 64, 64);
  REQUIRE(picture.has_value());
  return *picture;
}

double transmittance_at(const std::vector<DirtStroke>& strokes, Vec2 point_mm) {
  double transmittance = 1.0;
  for (const DirtStroke& s : strokes)
    if (s.distance_mm(point_mm) < 0.0) transmittance *= 1.0 - s.opacity;
  return transmittance;
}

// Calls body(middle) for kSub x kSub points of a pixel.
constexpr int kSub = 8;
template <class Body>
double mean_over_pixel(int x, int y, Body body) {
  double sum = 0.0;
  for (int i = 0; i < kSub * kSub; ++i) sum += body(Vec2{x + (i % kSub + 0.5) / kSub, y + (i / kSub + 0.5) / kSub});
  return sum / (kSub * kSub);
}

struct LensScene {
  LensState clean, dirty;
  test::Settings frame;
  Light light;
};

LensScene heliar_scene(const Dirt& dirt, double distance_mm = std::numeric_limits<double>::infinity()) {
  LensSettings settings{.f_number = 8.0, .iris = {6, 0.2}};
  LensScene scene;
  scene.clean = bundled("heliar", settings);
  settings.dirt = dirt;
  scene.dirty = bundled("heliar", settings);
  scene.frame = small_frame(scene.clean, 96, 64);
  scene.frame.selection = SelectBrightest{4};
  scene.light.distance_mm = distance_mm;
  scene.light.direction = direction_for_image_point(scene.clean, scene.frame.frame.sensor_from_uv({0.62, 0.4}),
                                                    scene.clean.design_wavelength_nm, distance_mm);
  return scene;
}

}  // namespace

// The plate's ghost is the stop's own image, pixel by pixel.
TEST_CASE("a plate's ghost has the shadows of its dirt where it lies, and loses as much light as that covers") {
  LensState lens = plate();
  const test::Settings settings = green({kSide, kSide, 0, 0, kSide, kSide, 0.08});
  const double area_mm2 = std::numbers::pi * kPlateRadius_mm * kPlateRadius_mm;
  const double level = 0.04 * 0.04 * 0.08 * 0.08 / area_mm2;
  for (const double opacity : {1.0, 0.6}) {
    CAPTURE(opacity);
    lens.dirt = some_dirt(DirtPlane::Stop);
    lens.dirt.opacity = opacity;
    const auto strokes = dirt_within(lens.dirt, {-4.0, -4.0}, {4.0, 4.0});
    REQUIRE(strokes.size() > 10);
    std::vector<double> expected;
    double passed = 0.0;
    for (int k = 0; k < kSide * kSide; ++k) {
      expected.push_back(mean_over_pixel(k % kSide, k / kSide, [&](Vec2 pixel) {
        const Vec2 at = settings.frame.sensor_from_pixel(pixel);
        return length(at) <= kPlateRadius_mm ? transmittance_at(strokes, at) : 0.0;
      }));
      passed += expected.back() * 0.08 * 0.08 / area_mm2;
    }
    REQUIRE(passed < 0.97);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_slow && opacity < 1.0) return;
      const Image image = image_of(bounds, lens, Light{}, settings);
      double squares = 0.0;
      for (int k = 0; k < kSide * kSide; ++k)
        squares += std::pow(image.at(k % kSide, k / kSide) / level - expected[static_cast<std::size_t>(k)], 2.0);
      // Counting has errors of some hundredths in pixels that an edge crosses; with one sample for each pixel, an edge
      // is a step.
      CHECK(std::sqrt(squares / (kSide * kSide)) < (bounds.traits.integrates_pixels ? 0.015 : 0.06));
      CHECK(sum(image) / 3.0 / (0.04 * 0.04) ==
            test::approx(passed).epsilon(bounds.traits.integrates_pixels ? 4e-3 : 0.04));
    });
  }
}

TEST_CASE("a picture of dirt dims what it covers") {
  LensState lens = plate();
  lens.dirt.picture = quarter_picture();
  lens.dirt.plane = DirtPlane::Stop;
  lens.surfaces[static_cast<std::size_t>(lens.stop_index)].semi_diameter_mm = 4.0;  // what it spans
  const test::Settings settings = green({kSide, kSide, 0, 0, kSide, kSide, 0.08});
  for_each_method([&](const Bounds& bounds) {
    const Image image = image_of(bounds, lens, Light{}, settings);
    CHECK(sum(image) / 3.0 / (0.04 * 0.04) == test::approx(0.875).epsilon(0.01));
    const double bright = image.at(25, 25);
    // The stop's upper right is the sensor's, which is the lower left of the image.
    CHECK(image.at(25, 55) == test::approx(0.5 * bright).epsilon(1e-3));
    CHECK(image.at(55, 55) == test::approx(bright).epsilon(1e-3));
    CHECK(image.at(55, 25) == test::approx(bright).epsilon(1e-3));
  });
}

TEST_CASE("ghosts of a lens lose what dirt blocks, and every renderer shows it where the reference does [slow]") {
  for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
    CAPTURE(static_cast<int>(plane));
    const LensScene s = heliar_scene(some_dirt(plane));
    const Image truth = truth_of(s.dirty, s.light, s.frame), without = truth_of(s.clean, s.light, s.frame);
    CHECK(sum(truth) < 0.99 * sum(without));
    CHECK(psnr_db(without, truth) < 45.0);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_exact) return;
      Bounds asked = bounds;
      asked.psnr_db = std::min(bounds.psnr_db, 50.0);  // bundle: points are linear over the cells of a grid of 128
      check_against(truth, image_of(bounds, s.dirty, s.light, s.frame), asked);
    });
  }
}

TEST_CASE("ringing and dirt together, and dirt before a near light, as the reference has them [slow]") {
  const auto check = [](const LensScene& s, double psnr) {
    const Image truth = truth_of(s.dirty, s.light, s.frame);
    CHECK(psnr_db(truth, truth_of(s.clean, s.light, s.frame)) < 45.0);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_exact) return;
      const Image image = image_of(bounds, s.dirty, s.light, s.frame);
      CHECK(psnr_db(truth, image) >= std::min(bounds.psnr_db, psnr));
      CHECK(sum(image) / sum(truth) == test::approx(1.0).epsilon(std::max(bounds.flux, 0.01)));
    });
  };
  LensScene ringing = heliar_scene(some_dirt(DirtPlane::Stop));
  ringing.frame.ringing.mode = RingingMode::Fresnel;
  check(ringing, 44.0);  // with fringes averaged over pixels, about 45 in so small a frame
  check(heliar_scene(some_dirt(DirtPlane::Front), 300.0), 49.5);  // 49.9 to 50.5, depending on the order of cells
}

// Independent of the renderers: the wave behind slits, by quadrature (Born & Wolf 8.7.3). F = a^2 / (550 nm * 12 mm).
TEST_CASE("with ringing, scratches have the fringes of slits [slow]") {
  LensState lens = plate();
  lens.dirt = {.scratches_per_cm2 = 1.5,
               .scratch_length_mm = Dirt::kLongest_mm,
               .scratch_width_mm = 0.1,
               .scratch_spread_rad = 0.0,
               .scratch_bend_rad = 0.0,
               .plane = DirtPlane::Stop,
               .seed = 3};
  constexpr int kHigh = 160;
  test::Settings settings = green({8, kHigh, 396, 400 - kHigh / 2, 800, 800, 0.01});
  const double unit_mm = std::sqrt(550e-6 * 12.0);
  const auto edge = [&](double mm) {  // far inside 1
    std::complex<double> sum(0.5, 0.0);
    constexpr double kStep = 1e-3;
    const double end = mm / unit_mm;
    for (int k = 0; k < static_cast<int>(std::abs(end) / kStep); ++k)
      sum += std::copysign(kStep, end) * std::polar(1.0, std::numbers::pi * (std::pow((k + 0.5) * kStep, 2.0) - 0.25));
    return sum;
  };
  std::vector<DirtStroke> seen;  // in the frame and as far outside it as fringes reach
  for (const DirtStroke& s : dirt_within(lens.dirt, {-3.0, -3.0}, {3.0, 3.0}))
    if (std::abs(s.middle_mm.y) < 1.1 && std::abs(s.middle_mm.x) < 0.4 * s.length_mm) seen.push_back(s);
  REQUIRE(seen.size() >= 2);
  const double level = 0.04 * 0.04 * 1e-4 / (std::numbers::pi * kPlateRadius_mm * kPlateRadius_mm);
  settings.set_error(1e-3);
  for_each_method([&](const Bounds& bounds) {
    const Image sharp = image_of(bounds, lens, Light{}, settings);
    test::Settings ringing = settings;
    ringing.ringing.mode = RingingMode::Fresnel;
    const Image image = image_of(bounds, lens, Light{}, ringing);
    double squares = 0.0, from_sharp = 0.0;
    for (int row = 0; row < kHigh; ++row) {
      const double y = settings.frame.sensor_from_pixel({4.5, row + 0.5}).y;
      std::complex<double> wave = 1.0;
      for (const DirtStroke& s : seen)
        wave *= 1.0 - (edge(y - s.middle_mm.y + 0.5 * s.width_mm) - edge(y - s.middle_mm.y - 0.5 * s.width_mm));
      squares += std::pow(image.at(4, row) / level - std::norm(wave), 2.0);
      from_sharp += std::pow(image.at(4, row) - sharp.at(4, row), 2.0) / (level * level);
    }
    // The fringes of a single wavelength beyond the third are left out.
    CHECK(std::sqrt(squares / kHigh) < 0.09);
    CHECK(std::sqrt(from_sharp / kHigh) > 0.15);
  });
}

// Independent of the renderers: rays through the front, counted in pixels.
TEST_CASE("shadows of the front lie where rays through the front say [slow]") {
  Dirt dirt = some_dirt(DirtPlane::Front);
  dirt.dust_mm = 1.0;
  dirt.dust_per_cm2 = 20.0;
  LensScene s = heliar_scene(dirt);
  const Ghost ghost{2, 3};
  s.frame = small_frame(s.clean, 72, 48);
  s.frame.selection = SelectList{{ghost}};
  const Vec3 direction = normalized(s.light.direction);
  const OpticalPath path = ghost_path(s.clean, ghost, 550.0);
  const EntranceWindow window = entrance_window(s.clean, direction);
  const auto strokes = dirt_within(dirt, {-12.0, -12.0}, {12.0, 12.0});
  std::vector<double> all(72 * 48), passed(all.size());
  constexpr int kRays = 600;
  for (int k = 0; k < kRays * kRays; ++k) {
    const Vec2 at{std::lerp(window.min_mm.x, window.max_mm.x, (k % kRays + 0.5) / kRays),
                  std::lerp(window.min_mm.y, window.max_mm.y, (k / kRays + 0.5) / kRays)};
    const TracedRay ray = trace(path, {{at.x, at.y, window.z_mm}, direction});
    if (ray.status != RayStatus::Ok || blocked_by(ray, path, s.clean.iris) > 0.0) continue;
    const Vec2 pixel = s.frame.frame.pixel_from_sensor(ray.sensor_mm);
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < 72.0 && pixel.y < 48.0)) continue;
    const auto index = static_cast<std::size_t>(pixel.y) * 72 + static_cast<std::size_t>(pixel.x);
    const Vec2 front = at + Vec2{direction.x, direction.y} * (-window.z_mm / direction.z);
    all[index] += ray.transmission;
    passed[index] += ray.transmission * transmittance_at(strokes, front);
  }
  for_each_method([&](const Bounds& bounds) {
    const Image lit = image_of(bounds, s.clean, s.light, s.frame), dark = image_of(bounds, s.dirty, s.light, s.frame);
    double squares = 0.0, flux = 0.0, flux_transmitted = 0.0;
    int counted = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      flux += all[k];
      flux_transmitted += passed[k];
      if (!(lit.pixels[3 * k + 1] > 0.2 * peak_of(lit)) || !(all[k] > 0.0)) continue;
      squares += std::pow(dark.pixels[3 * k + 1] / lit.pixels[3 * k + 1] - passed[k] / all[k], 2.0);
      ++counted;
    }
    REQUIRE(counted > 30);
    CHECK(flux_transmitted < 0.95 * flux);
    CHECK(std::sqrt(squares / counted) < (bounds.traits.integrates_pixels ? 0.05 : 0.1));
    CHECK(sum(dark) / sum(lit) == test::approx(flux_transmitted / flux).epsilon(0.01));
  });
}

TEST_CASE("without dirt the same bits as ever; threads do not matter") {
  LensScene s = heliar_scene(some_dirt(DirtPlane::Front));
  for_each_method([&](const Bounds& bounds) {
    if (bounds.traits.is_exact) return;
    LensState none = s.clean;
    none.dirt = Dirt{.dust_per_cm2 = 100.0, .opacity = 0.0, .seed = 4, .phase = 0.2};
    const auto expected = image_of(bounds, s.clean, s.light, s.frame).pixels;
    CHECK(image_of(bounds, none, s.light, s.frame).pixels == expected);
    const auto lights = std::span(&s.light, 1);
    const auto one = flare_of(bounds.method, s.dirty, lights, s.frame, {.threads = 1}).image.pixels;
    CHECK(one == flare_of(bounds.method, s.dirty, lights, s.frame, {.threads = 3}).image.pixels);
    CHECK(one != expected);
  });
}

// A frame takes some thousandths of a turn: half the time moves shadows half as far, and a whole turn restores them.
TEST_CASE("shadows wander smoothly and come back") {
  for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
    LensScene s = heliar_scene(some_dirt(plane));
    const auto at = [&](double phase) {
      s.dirty.dirt.phase = phase;
      return image_of(bounds_of("adaptive"), s.dirty, s.light, s.frame);
    };
    const Image start = at(0.25);
    const double peak = peak_of(start), frame = rms_difference(start, at(0.254)),
                 half = rms_difference(start, at(0.252));
    CHECK(frame > 1e-5 * peak);
    CHECK(frame < 0.02 * peak);
    CHECK(half < 0.8 * frame);
    CHECK(at(3.25).pixels == start.pixels);
  }
}

TEST_CASE("as much dirt as there may be leaves little light, and none of it negative [slow]") {
  LensState lens = plate();
  const test::Settings settings = green({40, 40, 0, 0, 40, 40, 0.16});
  const double level = 0.04 * 0.04 * 0.16 * 0.16 / (std::numbers::pi * kPlateRadius_mm * kPlateRadius_mm);
  for (const double dust_mm : {1e-4, 0.05, 4.0}) {
    for (const DirtPlane plane : {DirtPlane::Stop, DirtPlane::Front}) {
      CAPTURE(dust_mm);
      lens.dirt = some_dirt(plane);
      lens.dirt.dust_per_cm2 = Dirt::kMaxDustPerCm2;
      lens.dirt.dust_mm = dust_mm;
      lens.dirt.scratches_per_cm2 = dust_mm > 0.1 ? 0.0 : Dirt::kMaxScratchesPerCm2;
      for_each_method([&](const Bounds& bounds) {
        if (bounds.traits.is_exact) return;
        const Image image = image_of(bounds, lens, Light{}, settings);
        for (const float v : image.pixels) CHECK_UNARY(v > -1e-4 * level && v < 1.05 * level);
        if (dust_mm >= 4.0) CHECK(sum(image) == test::approx(0.0));
      });
    }
  }
}
