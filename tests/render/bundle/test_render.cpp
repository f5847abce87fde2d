// SPDX-License-Identifier: Apache-2.0
// The whole renderer's own properties; tests/render/all_methods checks what all renderers have in common.
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "render/bundle/bundle.h"
#include "render/bundle/scene.h"
#include "support/approx.h"
#include "support/planned.h"
#include "support/scenes.h"

using namespace contrejour;
using test::light_at;
using test::settings_for;

namespace {

Flare bundle_of(const LensState& lens, std::span<const Light> lights, const test::Settings& settings) {
  auto flare = test::render_alone(render_bundle, settings.bundle, lens, lights, settings);
  REQUIRE(flare.has_value());
  return *flare;
}

}  // namespace

TEST_CASE("bodonyi2023 eq. 13 spends fewer rays and stays close") {
  const LensState lens = test::lens("itoh-zoom", 32.0, 123.0);
  test::Settings settings = settings_for(lens, 160, 90, 256);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Flare full = bundle_of(lens, {&light, 1}, settings);
  settings.bundle.grid.scale = true;
  const Flare scaled = bundle_of(lens, {&light, 1}, settings);
  CHECK(scaled.statistics.rays < full.statistics.rays / 2);
  const auto difference = compare(full.image, scaled.image);
  REQUIRE(difference.has_value());
  CHECK(difference->psnr_db.value_or(1e9) > 40.0);
  CHECK(difference->flux_ratio[1] == test::approx(1.0).epsilon(0.01));
}

TEST_CASE("sigma and phi of eq. 13 set how many rays small ghosts get") {
  const LensState lens = test::lens("itoh-zoom", 32.0, 123.0);
  test::Settings settings = settings_for(lens, 96, 54, 256);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const auto rays = [&](double sigma, double phi) {
    settings.bundle.grid.sigma = sigma;
    settings.bundle.grid.phi = phi;
    return bundle_of(lens, {&light, 1}, settings).statistics.rays;
  };
  const std::uint64_t full = rays(1.0, 0.5);
  settings.bundle.grid.scale = true;
  const std::uint64_t papers = rays(1.0, 0.5);
  CHECK(papers < full / 2);
  CHECK(rays(16.0, 0.5) > papers);
  CHECK(rays(1.0 / 16.0, 0.5) < papers);
  CHECK(rays(1.0, 0.25) > papers);
  CHECK(rays(1.0, 1.0) < papers);
  CHECK(rays(1.0, 0.0) == full);
}

TEST_CASE("a grid of 4 rays a side does for well-behaved ghosts, a third of them here (hullin2011 7.1)") {
  const LensState lens = test::lens("heliar", 14.0);
  test::Settings settings = settings_for(lens, 160, 90, 4);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const std::vector<Ghost> ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  std::size_t good = 0;
  for (const Ghost& ghost : ghosts) {
    settings.selection = SelectList{{ghost}};
    settings.set_grid(4);
    const Flare coarse = bundle_of(lens, {&light, 1}, settings);
    settings.set_grid(128);
    const auto difference = compare(bundle_of(lens, {&light, 1}, settings).image, coarse.image);
    REQUIRE(difference.has_value());
    good += difference->psnr_db.value_or(1e9) >= 35.0 ? 1 : 0;
  }
  CHECK(good >= ghosts.size() / 3);
}

TEST_CASE("grids out of range are refused") {
  const LensState lens = test::lens("heliar", 16.0);
  const Light light;
  const auto refuses = [&](const test::Settings& settings) {
    const auto refused = test::render_alone(render_bundle, settings.bundle, lens, {&light, 1}, settings);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::InvalidArgument);
  };
  for (const int grid : {3, 513, -1}) refuses(settings_for(lens, 32, 18, grid));
  for (const double bad : {-0.5, 1e7, std::nan("")}) {
    test::Settings settings = settings_for(lens, 32, 18, 16);
    settings.bundle.grid.sigma = bad;
    refuses(settings);
    settings.bundle.grid.sigma = 1.0;
    settings.bundle.grid.phi = bad;
    refuses(settings);
  }
}
