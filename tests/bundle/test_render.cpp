// The whole renderer, where it has something of its own; what all renderers promise is in tests/renderers.
#include <doctest/doctest.h>

#include "bundle/scene.h"
#include "contrejour/metrics.h"
#include "render/bundle/bundle.h"
#include "support/scenes.h"

using namespace contrejour;
using test::light_at;
using test::settings_for;

namespace {

Flare bundle_of(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings) {
  auto flare = render_planned(render_bundle, lens, lights, settings, {});
  REQUIRE(flare.has_value());
  return *flare;
}

}  // namespace

TEST_CASE("bodonyi2023 eq. 13 spends fewer rays and stays close") {
  const LensState lens = test::lens("itoh-zoom", 32.0, 123.0);
  RenderSettings settings = settings_for(lens, 160, 90, 256);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Flare full = bundle_of(lens, {&light, 1}, settings);
  settings.scale_grid = true;
  const Flare scaled = bundle_of(lens, {&light, 1}, settings);
  CHECK(scaled.statistics.rays < full.statistics.rays / 2);
  const auto difference = compare(full.image, scaled.image);
  REQUIRE(difference.has_value());
  CHECK(difference->psnr_db.value_or(1e9) > 40.0);
  CHECK(difference->flux_ratio[1] == doctest::Approx(1.0).epsilon(0.01));
}

TEST_CASE("grids out of range are refused") {
  const LensState lens = test::lens("heliar", 16.0);
  const Light light;
  for (const int grid : {15, 513, -1}) {
    const auto refused = render_planned(render_bundle, lens, {&light, 1}, settings_for(lens, 32, 18, grid), {});
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::InvalidArgument);
  }
}
