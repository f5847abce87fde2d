// SPDX-License-Identifier: Apache-2.0
// Ghosts as random points, against the same ghosts as cells.
#include <atomic>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/pictures.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

// Two ghosts of the Heliar through an iris of six blades, one wavelength, 64 x 36 pixels.
struct Scene {
  LensState lens = bundled("heliar", {.f_number = 8.0, .iris = {6}});
  test::Settings settings = green(frame_on_sensor(lens, 64, 36));
  Light light = light_at(lens, settings.frame, {0.7, 0.33});

  Scene() {
    settings.selection = SelectList{{{2, 3}, {5, 7}}};
    settings.set_error(0.0005);
    settings.polynomial.fit = fit();
  }
  // No other iris needs another fit.
  [[nodiscard]] std::shared_ptr<const LensPolynomials> fit() const {
    static const std::shared_ptr<const LensPolynomials> made = [&] {
      auto fitted = fit_polynomials(lens, {.ghosts = {{2, 3}, {5, 7}}});
      REQUIRE(fitted.has_value());
      return std::make_shared<const LensPolynomials>(std::move(*fitted));
    }();
    return made;
  }
  [[nodiscard]] Flare drawn(int points, const Context& context = {}) const {
    test::Settings with = settings;
    with.polynomial.points = points;
    return flare_of("polynomial", lens, std::span(&light, 1), with, context);
  }
  [[nodiscard]] Error error_of(int points, const Context& context = {}) const {
    test::Settings with = settings;
    with.polynomial.points = points;
    const auto refused = render("polynomial", lens, std::span(&light, 1), with, context);
    REQUIRE_FALSE(refused.has_value());
    return refused.error();
  }
};

double psnr_db(const Image& truth, const Image& image) { return compare(truth, image)->psnr_db.value_or(1000.0); }

// Checks pictures of 256 and 1024 points a side against cells. One point in each cell of a grid: only pixels' and
// ghosts' borders are left to chance, about n of n^2 points, so that the error falls as n^-1.5, by 18 dB from 256 to
// 1024. Points anywhere would gain 12.
void check_convergence(const Scene& scene, double least_db) {
  const Image cells = scene.drawn(0).image;
  REQUIRE(sum(cells) > 0.0);
  const Image few = scene.drawn(256).image, many = scene.drawn(1024).image;
  const double few_db = psnr_db(cells, few), many_db = psnr_db(cells, many);
  CAPTURE(few_db);
  CHECK(many_db > least_db);
  CHECK(many_db - few_db > 13.0);
  CHECK(many_db - few_db < 22.0);
  CHECK(sum(many) / sum(cells) == test::approx(1.0).epsilon(0.005));
}

}  // namespace

TEST_CASE("random points converge to cells where rays are evaluated, and where they are traced [slow]") {
  Scene scene;
  CHECK(scene.drawn(64).statistics.traced_flux == 0.0);
  CHECK(scene.drawn(64).statistics.rays == 0);
  check_convergence(scene, 46.0);
  scene.light.distance_mm = 500.0;
  CHECK(scene.drawn(64).statistics.traced_flux == 1.0);
  CHECK(scene.drawn(64).statistics.rays >= 2 * 64 * 64);
  check_convergence(scene, 46.0);
}

TEST_CASE("points take a ghost's colour, offset and bands as cells do") {
  Scene scene;
  scene.settings.lambda_nm.clear();
  scene.settings.wavelengths = 3;
  scene.settings.ghosts.adjustments = {{.ghost = {5, 7}, .gain = 2.0, .colour = {1, 0.5, 0}, .offset = {0.1, -0.2}}};
  const Image cells = scene.drawn(0).image, points = scene.drawn(512).image;
  CHECK(psnr_db(cells, points) > 38.0);
  for (std::size_t channel = 0; channel < 3; ++channel)
    CHECK(compare(cells, points)->flux_ratio[channel] == test::approx(1.0).epsilon(0.005));
}

TEST_CASE("a picture as the iris blocks points as it clips cells [slow]") {
  Scene scene;
  scene.lens.iris = {};
  scene.lens.iris.field = flower_field();
  check_convergence(scene, 48.0);
}

TEST_CASE("points are the same for any number of threads, and in a window of the frame") {
  Scene scene;
  const Image whole = scene.drawn(1200, {.threads = 1}).image;  // two bands of rows for each ghost
  CHECK(scene.drawn(1200, {.threads = 3}).image.pixels == whole.pixels);
  Frame& frame = scene.settings.frame;
  frame.origin_x = 20;
  frame.origin_y = 9;
  frame.width = 30;
  frame.height = 20;
  const Image window = scene.drawn(1200).image;
  bool is_same = true;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 30; ++x) is_same = is_same && window.at(x, y) == whole.at(20 + x, 9 + y);
  CHECK(is_same);
}

TEST_CASE("a light with a size is drawn from points, too") {
  Scene scene;
  scene.light.radius_rad = 0.02;
  const Image cells = scene.drawn(0).image, points = scene.drawn(512).image;
  CHECK(psnr_db(cells, points) > 50.0);
  CHECK(sum(points) / sum(cells) == test::approx(1.0).epsilon(0.005));
}

TEST_CASE("points refuse what they cannot draw, and end when cancelled") {
  Scene scene;
  CHECK(scene.error_of(-1).code == ErrorCode::InvalidArgument);
  CHECK(scene.error_of(PolynomialRenderOptions::kMostPoints + 1).code == ErrorCode::InvalidArgument);
  std::atomic<bool> cancel = false;
  int reports = 0;
  const auto stop = [&](double) {
    ++reports;
    cancel = true;
  };
  CHECK(scene.error_of(1200, {.cancel = &cancel, .progress = stop}).code == ErrorCode::Cancelled);
  CHECK(reports == 1);
  Scene ringing = scene, dirty = scene, toned = scene;
  ringing.settings.ringing.mode = RingingMode::Fresnel;
  LensSettings dust{.f_number = 8.0};
  dust.dirt.dust_per_cm2 = 30.0;
  dirty.lens = bundled("heliar", dust);
  toned.lens.iris = {};
  toned.lens.iris.field = drawn_field(50, [](Vec2 p) { return p.x > 0.0 ? 0.4 : 1.0; });
  REQUIRE(toned.lens.iris.field->has_half_tones());
  for (const Scene* const one : {&ringing, &dirty, &toned}) {
    CHECK(one->error_of(64).code == ErrorCode::Unsupported);
    CHECK(one->drawn(0).image.width == 64);
  }
}
