// SPDX-License-Identifier: Apache-2.0
// Pictures from published polynomials: right without faults, and each fault changes them.
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "contrejour/expert/published_pictures.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::published;

namespace {

const LensState& pictured_lens() {
  static const LensState lens = [] {
    LensSettings settings{.f_number = 16.0};
    settings.iris.blades = 6;
    const auto found = find_lens("heliar");
    REQUIRE(found.has_value());
    auto state = configure_lens(*found, settings);
    REQUIRE(state.has_value());
    return std::move(*state);
  }();
  return lens;
}

PictureOptions small_picture() {
  PictureOptions options;
  options.light = {0.2, 0.1};
  options.width = 60, options.height = 40;
  options.points = 160, options.samples = 700;
  return options;
}

double psnr_db(const Image& a, const Image& b) {
  const auto compared = compare(a, b);
  REQUIRE(compared.has_value());
  return compared->psnr_db.value_or(200.0);
}

double sum_of(const Image& image) { return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0); }

}  // namespace

TEST_CASE("pictures from polynomials are right, and each fault of the thesis's code spoils them [slow]") {
  const PictureOptions options = small_picture();
  const auto traced = draw_traced_ghosts(pictured_lens(), options);
  const auto fitted = draw_fitted_ghosts(pictured_lens(), options);
  REQUIRE((traced.has_value() && fitted.has_value()));
  const double right_db = psnr_db(*traced, *fitted);
  CHECK(right_db > 38.0);
  CHECK(sum_of(*fitted) == test::approx(sum_of(*traced)).epsilon(0.02));
  const std::vector<std::pair<const char*, PictureFaults>> faults{{"output order", {.output_order = true}},
                                                                  {"stop counted", {.stop_counted = true}},
                                                                  {"next ghost", {.next_ghost = true}},
                                                                  {"no stop position", {.no_stop_position = true}},
                                                                  {"extrapolated", {.extrapolated = true}}};
  for (const auto& [name, fault] : faults) {
    PictureOptions wrong = options;
    wrong.faults = fault;
    const auto image = draw_fitted_ghosts(pictured_lens(), wrong);
    REQUIRE(image.has_value());
    CHECK_MESSAGE(psnr_db(*traced, *image) < right_db - 6.0, name);
  }
}

TEST_CASE("pictures do not depend on the number of threads, and random points converge [slow]") {
  PictureOptions options = small_picture();
  options.points = 60;
  const auto one = draw_fitted_ghosts(pictured_lens(), options, {.threads = 1});
  const auto three = draw_fitted_ghosts(pictured_lens(), options, {.threads = 3});
  REQUIRE((one.has_value() && three.has_value()));
  CHECK(one->pixels == three->pixels);
  const auto grid = draw_fitted_ghosts(pictured_lens(), small_picture());
  REQUIRE(grid.has_value());
  double last_db = 0.0;
  for (const int points : {20, 80, 320}) {  // 16 times as many rays: a quarter of the noise
    PictureOptions random = options;
    random.points = points;
    random.random_points = true;
    const auto image = draw_fitted_ghosts(pictured_lens(), random);
    REQUIRE(image.has_value());
    const double db = psnr_db(*grid, *image);
    CHECK(db > last_db + 5.0);
    last_db = db;
  }
}

TEST_CASE("the thesis's system is drawn from its rays and from polynomials") {
  TwoLensesPicture picture;
  picture.system = {TwoLenses::Tracer::Spheres, kTwoLensesDrawnSensor_z};
  picture.size = 40, picture.points = 200;
  const auto traced = draw_two_lenses(picture);
  REQUIRE(traced.has_value());
  CHECK(sum_of(*traced) > 0.1);  // of 1 without losses
  CHECK(sum_of(*traced) < 0.9);  // the stop and total reflection take some
  const Polynomial x{Basis::Monomials, {{{0, 0, 1, 0}, 0.5}}}, y{Basis::Monomials, {{{0, 0, 0, 1}, 0.5}}};
  picture.x = &x, picture.y = &y;
  picture.half_size = 1.0;
  const auto square = draw_two_lenses(picture);
  REQUIRE(square.has_value());
  CHECK(sum_of(*square) == test::approx(1.0));
  CHECK(square->pixels[20 * 40 + 20] == test::approx(1.0 / 400.0).epsilon(2e-3));  // over half of each side, evenly
  CHECK(square->pixels[20 * 40 + 5] == 0.0F);
}

TEST_CASE("pictures without sense are refused") {
  PictureOptions options = small_picture();
  options.width = 0;
  CHECK(!draw_traced_ghosts(pictured_lens(), options).has_value());
  options = small_picture();
  options.degree = 17;
  CHECK(!draw_fitted_ghosts(pictured_lens(), options).has_value());
  options = small_picture();
  options.half_range = 0.0;
  CHECK(!draw_fitted_ghosts(pictured_lens(), options).has_value());
  const Polynomial x;
  TwoLensesPicture picture;
  picture.x = &x;
  CHECK(!draw_two_lenses(picture).has_value());
}
