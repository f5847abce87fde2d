// SPDX-License-Identifier: Apache-2.0
// Small pictures kept in the repository: a change that moves a ghost, a colour or a level shows up here first. They are
// compared with a tolerance.
#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "support/approx.h"
#include "support/kept_picture.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

constexpr double kAlike_db = 55.0;  // instruction sets differ only by rounding, far above this

struct Golden {
  const char* lens;
  LensSettings settings;
  Vec2 uv;
  Spectrum spectrum;
};

const Golden kGolden[] = {
    {"heliar", {.f_number = 8.0}, {0.70, 0.33}, IlluminantD65{}},
    {"canon-70-200", {.focal_length_mm = 135.0, .f_number = 16.0, .iris = {8, 0.2}}, {0.25, 0.75}, IlluminantD65{}},
    {"nakamura-22", {.f_number = 5.6}, {1.1, 0.2}, BlackBody{3200.0}},
};

Image rendered(const Golden& golden) {
  const LensState lens = test::bundled(golden.lens, golden.settings);
  test::Settings settings;
  settings.wavelengths = 3;
  settings.scope = GhostScope::OneSideOfStop;  // as in the kept pictures
  settings.frame = frame_on_sensor(lens, 96, 64);
  settings.set_grid(96);
  Light light = test::light_at(lens, settings.frame, golden.uv);
  light.spectrum = golden.spectrum;
  light.value = {1e4, 1e4, 1e4};
  const auto flare = render("bundle", lens, {&light, 1}, settings);
  REQUIRE(flare.has_value());
  return flare->image;
}

}  // namespace

TEST_CASE("golden pictures [slow]") {
  for (const Golden& golden : kGolden) {
    CAPTURE(golden.lens);
    const Image image = rendered(golden);
    const Image kept = test::kept_picture(golden.lens, [&] { return image; }, SampleType::Half);
    const auto difference = compare(kept, image);
    REQUIRE(difference.has_value());
    CHECK(difference->psnr_db.value_or(1000.0) > kAlike_db);
    for (const double ratio : difference->flux_ratio) CHECK(ratio == test::approx(1.0).epsilon(2e-3));
  }
}
