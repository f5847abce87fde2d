// SPDX-License-Identifier: Apache-2.0
// Lenses with aspheres and with cylinders: every method against the reference, with few ghosts and small frames. Single
// rays at such surfaces are tested in tests/optics/trace/test_surfaces.cpp.
#include <algorithm>

#include "render/all_methods/methods.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

LensState changed_tessar(const SurfaceShape& front, const SurfaceShape& rear) {
  const auto tessar = find_lens("tessar");
  REQUIRE(tessar.has_value());
  Prescription lens = *tessar;
  lens.surfaces.front().shape = front;
  lens.surfaces.back().shape = rear;
  const auto state = configure_lens(lens, {.f_number = 11.0});
  REQUIRE(state.has_value());
  return *state;
}

// With all accelerations that a lens with axial symmetry allows. Where `kept` is not empty, it is the name of the
// reference's kept picture.
void check_all(const LensState& lens, Vec2 uv, int width = 72, const std::string& kept = {}) {
  test::Settings settings = small_frame(lens, width, width * 2 / 3);
  settings.bundle.mirror_symmetry = settings.bundle.precomputed_bounds = true;
  const Light light = light_at(lens, settings.frame, uv);
  const Image truth = kept.empty() ? truth_of(lens, light, settings) : kept_truth_of(kept, lens, light, settings);
  const Image spherical = image_of(bounds_of("bundle"), bundled("tessar", {.f_number = 11.0}), light, settings);
  CHECK(psnr_db(truth, spherical) < 40.0);
  for_each_method([&](const Bounds& bounds) {
    if (!bounds.traits.is_exact) check_against(truth, image_of(bounds, lens, light, settings), bounds);
  });
}

}  // namespace

TEST_CASE("a lens with aspheres as in the reference, and unlike its spheres [slow]") {
  check_all(changed_tessar({.conic = -2.0, .powers = {0, 0, 0, 2e-5, 0, -1e-8}}, {.powers = {0, 0, 1e-5, 1e-5}}),
            {0.66, 0.37});
}

TEST_CASE("a lens with a toroid and a biconic, turned by odd angles, as in the reference [slow]") {
  const double c = find_lens("tessar")->surfaces.front().curvature_per_mm;
  check_all(
      changed_tessar({.kind = ShapeKind::Toroid, .curvature_x_per_mm = 0.6 * c, .rotation_rad = 0.4},
                     {.kind = ShapeKind::Biconic, .conic = -0.5, .curvature_x_per_mm = -0.7 * c, .rotation_rad = -0.2}),
      {0.66, 0.37});
}

TEST_CASE("rims that are an ellipse and a turned rectangle, as in the reference, and unlike circles [slow]") {
  auto tessar = find_lens("tessar");
  REQUIRE(tessar.has_value());
  const double front_mm = tessar->surfaces.front().semi_diameter_mm, rear_mm = tessar->surfaces.back().semi_diameter_mm;
  tessar->surfaces.front().aperture = {ApertureKind::Rectangle, {0.6 * front_mm, 0.35 * front_mm}, {0.3, 0.0}, 0.5};
  tessar->surfaces.back().aperture = {ApertureKind::Ellipse, {0.4 * rear_mm, 0.7 * rear_mm}, {}, 0.2};
  const auto lens = configure_lens(*tessar, {.f_number = 8.0});
  REQUIRE(lens.has_value());
  check_all(*lens, {0.66, 0.37});
}

TEST_CASE(
    "obscurations on the front, askew on glass and before the stop, as in the reference, and unlike open surfaces "
    "[slow]") {
  auto tessar = find_lens("tessar");
  REQUIRE(tessar.has_value());
  const double front_mm = tessar->surfaces.front().semi_diameter_mm, rear_mm = tessar->surfaces.back().semi_diameter_mm;
  std::string kept = "obscured-centre";
  SUBCASE("centred") { tessar->surfaces.front().obscuration = {{0.3 * front_mm, 0.3 * front_mm}, {}, 0.0}; }
  SUBCASE("askew, and of more than one surface") {
    kept = "obscured-askew";
    tessar->surfaces.front().obscuration = {{0.25 * front_mm, 0.2 * front_mm}, {0.1 * front_mm, 0.0}, 0.5};
    tessar->surfaces.back().obscuration = {{0.2 * rear_mm, 0.2 * rear_mm}, {}, 0.0};
  }
  SUBCASE("of the stop") {
    kept = "obscured-stop";
    const auto stop = std::ranges::find(tessar->surfaces, SurfaceKind::Stop, &Surface::kind);
    stop->obscuration = {{0.1 * stop->semi_diameter_mm, 0.1 * stop->semi_diameter_mm}, {}, 0.0};
  }
  const auto lens = configure_lens(*tessar, {.f_number = 8.0});
  REQUIRE(lens.has_value());
  check_all(*lens, {0.66, 0.37}, 120, kept);  // edges are as long again, and `tiled` samples them
}

TEST_CASE("a cover glass and a sensor that reflects in orders, as in the reference [slow]") {
  LensSettings adjustment{.f_number = 8.0};  // dots of some pixels, which `tiled` samples
  adjustment.sensor = {
      .plates = {{2.0, 15.0, Glass{"", ConstantIndex{1.5}}, {}}}, .reflectance = 0.2, .orders = 1, .pitch_mm = 0.008};
  const LensState lens = bundled("tessar", adjustment);
  check_all(lens, {0.6, 0.4}, 72, "cover-glass");
}
