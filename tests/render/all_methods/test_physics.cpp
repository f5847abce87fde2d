// SPDX-License-Identifier: Apache-2.0
// Physics that every renderer must get right: closed forms, and whole lenses against the reference.
#include <cmath>
#include <numbers>

#include "render/all_methods/methods.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

// A sphere of glass behind a much smaller stop: rays meet it almost at right angles.
LensState ball() {
  Prescription lens;
  lens.surfaces = {{SurfaceKind::Stop, 0.0, 1.0, 20.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.1, 20.0, 9.0, {"", ConstantIndex{1.5}}, {}, 0},
                   {SurfaceKind::Refracting, -0.1, 0.0, 9.0, air(), {}, 0}};
  LensState state = configured(lens, 0.5);
  state.sensor_z_mm = 30.0;
  return state;
}

Vec2 centroid_px(const Image& image) {
  Vec2 moment;
  double total = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      moment = moment + Vec2{x + 0.5, y + 0.5} * image.at(x, y);
      total += image.at(x, y);
    }
  }
  return moment * (1.0 / total);
}

struct System {
  const char* name;
  LensSettings settings;
  Vec2 uv{0.70, 0.33};
  double allowance_db = 0.0;  // subtracted from the method's PSNR
};

void check_system(const System& system, const Image& truth) {
  const std::string lens_name(system.name);
  CAPTURE(lens_name);
  const LensState lens = bundled(system.name, system.settings);
  const test::Settings settings = small_frame(lens, truth.width, truth.height);
  const Light light = light_at(lens, settings.frame, system.uv);
  for_each_method([&](Bounds bounds) {
    if (bounds.traits.is_exact) return;
    bounds.psnr_db -= system.allowance_db;
    check_against(truth, image_of(bounds, lens, light, settings), bounds);
  });
}

struct SystemScene {
  LensState lens;
  test::Settings settings;
  Light light;
};

SystemScene scene_of(const System& system, double density) {
  SystemScene scene{.lens = bundled(system.name, system.settings)};
  scene.settings = small_frame(scene.lens, 160, 90);
  scene.settings.reference.density = density;
  scene.light = light_at(scene.lens, scene.settings.frame, system.uv);
  return scene;
}

}  // namespace

TEST_CASE("a plate's ghost is a level disc of R^2 times the light") {
  const LensState lens = plate();
  const test::Settings settings = green({120, 120, 0, 0, 120, 120, 0.08});
  const Light light;
  const double r = 0.04;  // ((1.5 - 1) / (1.5 + 1))^2
  // V = 1: E_ghost A_pixel / Phi = R^2 * pixel area / stop area.
  const double level = r * r * 0.08 * 0.08 / (std::numbers::pi * 9.0);
  for_each_method([&](const Bounds& bounds) {
    const Image image = image_of(bounds, lens, light, settings);
    double worst = 0.0;
    double stray = 0.0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 120; ++x) {
        const double from_centre_mm = std::hypot(x + 0.5 - 60.0, y + 0.5 - 60.0) * 0.08;
        if (from_centre_mm < 2.8) worst = std::max(worst, std::abs(image.at(x, y) / level - 1.0));
        if (from_centre_mm > 3.2) stray = std::max(stray, std::abs(image.at(x, y) / level));
      }
    }
    CHECK(worst < 0.005);
    CHECK(stray < 1e-6);
    CHECK(sum(image) / 3.0 == test::approx(r * r).epsilon(std::max(bounds.flux, 1e-3)));
  });
}

TEST_CASE("a ball's ghost carries R^2, at almost normal incidence") {
  const LensState lens = ball();
  const test::Settings settings = small_frame(lens, 90, 60);
  Light light;
  light.direction = normalized({-0.01, 0.02, 1.0});
  const Image truth = truth_of(lens, light, settings);
  for_each_method([&](const Bounds& bounds) {
    const double flux = sum(image_of(bounds, lens, light, settings));
    CHECK(flux / 3.0 == test::approx(0.04 * 0.04).epsilon(std::max(bounds.flux, 0.01)));
    CHECK(flux / sum(truth) == test::approx(1.0).epsilon(bounds.flux));
  });
}

TEST_CASE("pictures are upright: a plate's ghost of a light up and to the right is up and to the right") {
  const LensState lens = plate();
  const test::Settings settings = green({100, 100, 0, 0, 100, 100, 0.1});
  Light light;
  light.direction = direction_from_angles(0.15, 0.1);
  // 8 mm of air, and three times through 2 mm of glass of n = 1.5.
  const Vec3 d = light.direction;
  const Vec2 across{d.x, d.y};
  const double sine = length(across) / 1.5;
  const Vec2 image_point = across * (8.0 / d.z) + across * (6.0 / 1.5 / std::sqrt(1.0 - sine * sine));
  const Vec2 expected = settings.frame.pixel_from_sensor(image_point);
  for_each_method([&](const Bounds& bounds) {
    const Vec2 middle = centroid_px(image_of(bounds, lens, light, settings));
    CHECK(middle.x > 60.0);
    CHECK(middle.y < 45.0);
    CHECK(length(middle - expected) < 0.1);
  });
}

TEST_CASE("small systems against the reference [slow]") {
  for (const System& system :
       {System{"heliar", {.f_number = 16.0}}, System{"heliar", {.f_number = 4.5}, {0.3, 0.8}},
        System{"tessar", {.f_number = 11.0}}, System{"itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0}},
        System{"planar-50", {.f_number = 2.8}},
        // Ghosts through a thousandth of the front.
        System{"muller-fisheye-10", {.f_number = 11.0}, {0.70, 0.33}}}) {
    const SystemScene scene = scene_of(system, 0.7);
    const std::string kept = std::string(system.name) + "-" + std::to_string(system.settings.f_number.value());
    check_system(system, kept_truth_of(kept.substr(0, kept.find('.')), scene.lens, scene.light, scene.settings));
  }
}

TEST_CASE("the reference renders what is kept of it [slow]") {
  const SystemScene prime = scene_of({"heliar", {.f_number = 16.0}}, 0.7);
  const SystemScene zoom = scene_of({"itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0}}, 0.7);
  for (const auto& [name, scene] : {std::pair{"heliar-16", prime}, std::pair{"itoh-zoom-32", zoom}}) {
    CAPTURE(name);
    const Image kept = kept_truth_of(name, scene.lens, scene.light, scene.settings);
    const Image now = truth_of(scene.lens, scene.light, scene.settings);
    CHECK(psnr_db(kept, now) >= 80.0);
    CHECK(sum(now) / sum(kept) == test::approx(1.0).epsilon(1e-5));
  }
}

TEST_CASE("long zooms against the reference [slow]") {
  const std::pair<const char*, System> kKept[] = {
      {"nikon-140", {"nikon-80-200", {.focal_length_mm = 140.0, .f_number = 16.0}}},
      {"canon-135", {"canon-70-200", {.focal_length_mm = 135.0, .f_number = 32.0}}},
      {"canon-200", {"canon-70-200", {.focal_length_mm = 200.0, .f_number = 32.0}}}};
  for (const auto& [name, system] : kKept) {
    const SystemScene scene = scene_of(system, 1.0);
    check_system(system, kept_truth_of(name, scene.lens, scene.light, scene.settings));
  }
}

TEST_CASE("every pair of surfaces: more ghosts, as in the reference [slow]") {
  const LensState lens = bundled("heliar", {.f_number = 5.6});
  test::Settings settings = small_frame(lens, 72, 48);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  settings.scope = GhostScope::All;
  settings.reference.density = 0.7;
  const Image truth = kept_truth_of("heliar-all", lens, light, settings);
  for_each_method([&](const Bounds& bounds) {
    if (bounds.traits.is_exact) return;
    settings.scope = GhostScope::All;
    const Flare all = flare_of(bounds.method, lens, {&light, 1}, settings);
    settings.scope = GhostScope::OneSideOfStop;
    const Flare one_side = flare_of(bounds.method, lens, {&light, 1}, settings);
    CHECK(all.statistics.ghosts_rendered == 28);
    CHECK(one_side.statistics.ghosts_rendered == 13);
    CHECK(sum(all.image) > sum(one_side.image));
    check_against(truth, all.image, bounds);
  });
}

TEST_CASE("blades of an iris, lights on the axis and outside the frame, as in the reference [slow]") {
  struct Case {
    const char* kept;
    Iris iris;
    Vec2 uv;
  };
  for (const Case& c : {Case{"iris", {6, 0.3}, {0.70, 0.33}}, Case{"iris-axis", {}, {0.5, 0.5}},
                        Case{"iris-axis-blades", {5, 0.0}, {0.5, 0.5}}, Case{"iris-outside", {}, {1.15, 0.4}}}) {
    const std::string kept(c.kept);
    CAPTURE(kept);
    const LensState lens = bundled("heliar", {.f_number = 11.0, .iris = c.iris});
    test::Settings settings = small_frame(lens, 96, 64);
    settings.reference.density = c.iris.blades > 0 ? 1.4 : 0.7;  // at 1 it has errors at an iris's corners
    Light light = light_at(lens, settings.frame, c.uv);
    if (c.uv == Vec2{0.5, 0.5}) light.direction = {0.0, 0.0, 1.0};
    const Image truth = kept_truth_of(c.kept, lens, light, settings);
    CHECK(sum(truth) > 0.0);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_exact) return;
      check_against(truth, image_of(bounds, lens, light, settings), bounds);
    });
  }
}

TEST_CASE("by default each channel has the light of many wavelengths, by every method [slow]") {
  // Coatings with minima between three wavelengths: with only these, red and green had errors of 3 to 20 per cent.
  for (const auto& [name, f_number] : {std::pair{"tessar", 8.0}, std::pair{"muller-fisheye-10", 11.0}}) {
    CAPTURE(name);
    const LensState lens = bundled(name, {.f_number = f_number});
    test::Settings settings;
    settings.frame = frame_on_sensor(lens, 64, 36);
    settings.set_grid(48);
    settings.reference.density = 0.1;
    const Light light = light_at(lens, settings.frame, {0.7, 0.35});
    const auto sums = [&](const Image& image) {
      Rgb out{};
      for (std::size_t k = 0; k < image.pixels.size(); ++k) out[k % 3] += image.pixels[k];
      return out;
    };
    test::Settings many = settings;
    many.wavelengths = 64;
    many.set_error(1e-3);
    const Rgb truth = sums(flare_of("adaptive", lens, {&light, 1}, many).image);
    for_each_method([&](const Bounds& bounds) {
      const Rgb ours = sums(image_of(bounds, lens, light, settings));
      for (std::size_t c = 0; c < 3; ++c) CHECK(ours[c] / truth[c] == test::approx(1.0).epsilon(bounds.flux + 0.02));
    });
  }
}
