// SPDX-License-Identifier: Apache-2.0
// The exposure of a preview.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/expert/preview_exposure.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::params;

namespace {

Image level_picture(float level) {
  Image rgb(40, 25);
  std::fill(rgb.pixels.begin(), rgb.pixels.end(), level);
  return rgb;
}

}  // namespace

TEST_CASE("the automatic exposure brings the bright parts to 0.7") {
  for (const float level : {1e-6F, 0.7F, 3e4F})
    CHECK(level * std::exp2(automatic_exposure(level_picture(level))) == test::approx(0.7));
  Image spark = level_picture(0.35F);
  spark.pixels[0] = 1e6F;  // one sample of 3000 is ignored
  CHECK(automatic_exposure(spark) == test::approx(1.0));
  CHECK(automatic_exposure(level_picture(0.0F)) == 0.0);
  CHECK(automatic_exposure(level_picture(1e-37F)) == 100.0);
}

TEST_CASE("a preview is exposed as the values say, else as usual") {
  const Image rgb = level_picture(2.8F);
  const auto stops = [&](const char* text, DefaultExposure otherwise) {
    Values values;
    if (text != nullptr) REQUIRE(values.set("exposure", text).has_value());
    return preview_settings(values, rgb, otherwise).exposure_stops;
  };
  CHECK(stops(nullptr, DefaultExposure::None) == 0.0);
  CHECK(stops(nullptr, DefaultExposure::Automatic) == test::approx(-2.0));
  for (const DefaultExposure otherwise : {DefaultExposure::None, DefaultExposure::Automatic}) {
    CHECK(stops("1.5", otherwise) == 1.5);
    CHECK(stops("auto", otherwise) == test::approx(-2.0));
  }
}
