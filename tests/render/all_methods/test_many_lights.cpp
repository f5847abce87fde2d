// SPDX-License-Identifier: Apache-2.0
// Many lights drawn from one fit, and a fit of a range of focus, against traced rays.
#include <cmath>

#include "contrejour/expert/polynomial_range.h"
#include "render/all_methods/methods.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

// `polynomial` once lost 0.9 per cent of the light of such frames, as it gave its ghosts too large a part of the error.
TEST_CASE("twenty lights of a zoom have the same flux by polynomials as by traced rays [slow]") {
  const LensState lens = bundled("nikon-80-200");
  test::Settings settings = small_frame(lens, 192, 128);
  SelectList some;  // of all kinds, so that few need a fit
  const std::vector<Ghost> ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  for (std::size_t k = 0; k < ghosts.size(); k += 7) some.ghosts.push_back(ghosts[k]);
  settings.selection = some;
  std::vector<Light> lights;
  for (int k = 0; k < 20; ++k)
    lights.push_back(
        light_at(lens, settings.frame,
                 {std::fmod(0.5 + 0.7548776662466927 * k, 1.0), std::fmod(0.5 + 0.5698402909980532 * k, 1.0)}));
  const Flare traced = flare_of("adaptive", lens, lights, settings);
  const Flare fitted = flare_of("polynomial", lens, lights, settings);
  CHECK(fitted.statistics.traced_flux < 0.2);
  CHECK(sum(fitted.image) / sum(traced.image) == test::approx(1.0).epsilon(0.005));
}

TEST_CASE("a fit of a range of focus draws each of its states as accurately as traced rays [slow]") {
  const auto lens = find_lens("cooke-triplet");
  REQUIRE(lens.has_value());
  const std::vector<Ghost> ghosts{{1, 2}, {3, 6}};
  auto made = fit_polynomial_range(*lens, {},
                                   {.variable = PolynomialVariable::Focus,
                                    .from_mm = 1500.0,
                                    .to_mm = INFINITY,
                                    .fit = {.max_halvings = 0, .ghosts = ghosts}});
  REQUIRE(made.has_value());
  const auto range = std::make_shared<const LensPolynomialRange>(std::move(*made));
  for (const double distance_mm : {1700.0, 5000.0}) {
    CAPTURE(distance_mm);
    const LensState state = bundled("cooke-triplet", {.f_number = 5.6, .object_distance_mm = distance_mm});
    test::Settings settings = small_frame(state, 96, 64);
    settings.selection = SelectList{ghosts};
    settings.polynomial.range = range;
    const Light light = light_at(state, settings.frame, {0.70, 0.33});
    const Flare flare = flare_of("polynomial", state, std::span(&light, 1), settings);
    CHECK(flare.statistics.traced_flux == 0.0);
    check_against(truth_of(state, light, settings), flare.image, bounds_of("polynomial"));
  }
  const LensState nearer = bundled("cooke-triplet", {.object_distance_mm = 1000.0});
  test::Settings settings = small_frame(nearer, 16, 16);
  settings.polynomial.range = range;
  CHECK_FALSE(test::render("polynomial", nearer, std::span<const Light>(), settings).has_value());
}
