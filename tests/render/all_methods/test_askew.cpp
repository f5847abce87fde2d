// SPDX-License-Identifier: Apache-2.0
// Lenses with tilted and decentred elements: no renderer may assume that they have axial symmetry.
#include "render/all_methods/methods.h"

using namespace contrejour;
using namespace contrejour::test;

TEST_CASE("a lens with errors as in the reference, and unlike the lens as it ought to be [slow]") {
  for (const char* name : {"heliar", "tessar"}) {
    const std::string what(name);
    CAPTURE(what);
    const LensState lens = bundled(name, {.f_number = 11.0, .build = {0.01, 0.3, 2}});
    const LensState ideal = bundled(name, {.f_number = 11.0});
    test::Settings settings = small_frame(lens, 96, 64);
    Light light = light_at(ideal, settings.frame, {0.70, 0.33});
    if (what == "tessar") light.distance_mm = 500.0;
    const Image truth = kept_truth_of("askew-" + what, lens, light, settings);
    CHECK(psnr_db(truth, image_of(bounds_of("bundle"), ideal, light, settings)) < 40.0);
    for_each_method([&](const Bounds& bounds) {
      if (bounds.traits.is_exact) return;
      check_against(truth, image_of(bounds, lens, light, settings), bounds);
      // Options that need symmetry have no effect.
      settings.bundle.mirror_symmetry = settings.bundle.precomputed_bounds = true;
      check_against(truth, image_of(bounds, lens, light, settings), bounds);
      settings.bundle = {};
    });
  }
}

TEST_CASE("on the axis a lens with errors is not symmetric; the same for any threads; no errors, no change [slow]") {
  const LensState lens = bundled("heliar", {.f_number = 11.0, .build = {0.005, 0.2, 4}});
  const LensState none = bundled("heliar", {.f_number = 11.0, .build = {0.0, 0.0, 4}});
  const LensState ideal = bundled("heliar", {.f_number = 11.0});
  test::Settings settings = small_frame(lens, 72, 48);
  const Light light;
  const Image truth = truth_of(lens, light, settings);
  settings.reference.density = 0.2;
  for_each_method([&](const Bounds& bounds) {
    if (!bounds.traits.is_exact) check_against(truth, image_of(bounds, lens, light, settings), bounds);
    const Image one = flare_of(bounds.method, lens, {&light, 1}, settings, {.threads = 1}).image;
    const Image three = flare_of(bounds.method, lens, {&light, 1}, settings, {.threads = 3}).image;
    CHECK(one.pixels == three.pixels);
    CHECK(image_of(bounds, none, light, settings).pixels == image_of(bounds, ideal, light, settings).pixels);
  });
}

TEST_CASE("polynomials draw a ghost of a decentred lens as the reference does, from light of both sides") {
  auto triplet = find_lens("cooke-triplet");
  REQUIRE(triplet.has_value());
  for (std::size_t k = 0; k < 2; ++k) triplet->surfaces[k].pose.shift_mm = {0.15, 0.0, 0.0};
  const auto lens = configure_lens(*triplet);
  REQUIRE(lens.has_value());
  test::Settings settings = small_frame(*lens, 96, 64);
  settings.selection = SelectList{{{1, 2}}};
  const auto fit =
      fit_polynomials(*lens, {.half_field_rad = 0.15, .max_order = 9, .max_halvings = 0, .ghosts = {{1, 2}}});
  REQUIRE(fit.has_value());
  settings.polynomial.fit = std::make_shared<const LensPolynomials>(*fit);
  for (const Vec2 at : {Vec2{0.62, 0.41}, Vec2{0.45, 0.62}}) {
    const Light light = light_at(*lens, settings.frame, at);
    const Flare fitted = flare_of("polynomial", *lens, {&light, 1}, settings);
    CHECK(fitted.statistics.traced_flux == 0.0);
    CHECK(psnr_db(truth_of(*lens, light, settings), fitted.image) > 50.0);
  }
}
