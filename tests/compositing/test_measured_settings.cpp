// SPDX-License-Identifier: Apache-2.0
// A user's values with a measured flare in place of a lens.
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "contrejour/expert/measured_settings.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

MeasuredFlare mirrored_disc() {
  MeasuredGhost disc;
  disc.centre.coefficients = {-1.0};  // on the other side of the axis, as far from it as the light
  disc.half_width.coefficients = disc.half_height.coefficients = {0.1};
  for (AngleCurve& level : disc.inside) level.coefficients = {1.0};
  disc.last = 0.7;
  return {"disc", "", 0.7, CaptureExposure{2.0, 100.0, 1.0}, {disc}, Vec2{0.6, 0.4}};
}

params::Values values_with(std::initializer_list<std::pair<const char*, const char*>> given) {
  params::Values values;
  for (const auto& [name, text] : given) REQUIRE(values.set(name, text).has_value());
  return values;
}

}  // namespace

TEST_CASE("measured settings: options of a lens are refused by name, their defaults are not") {
  const MeasuredFlare flare = mirrored_disc();
  CHECK(check_measured_values(flare, values_with({{"light", "1,2"}, {"blades", "0"}}), MeasuredUse::Lights));
  const auto refused = check_measured_values(flare, values_with({{"blades", "6"}}), MeasuredUse::Lights);
  REQUIRE(!refused);
  CHECK(refused.error().message.find("--blades") == 0);
  CHECK(check_measured_values(flare, values_with({{"iso", "200"}}), MeasuredUse::Lights));
  CHECK(!check_measured_values(flare, values_with({{"iso", "200"}}), MeasuredUse::Photograph));
  MeasuredFlare fieldless = flare;
  fieldless.half_field.reset();
  CHECK(!check_measured_values(fieldless, {}, MeasuredUse::Lights));
  CHECK(check_measured_values(fieldless, values_with({{"hfov", "50"}}), MeasuredUse::Lights));
}

TEST_CASE("measured settings: equation 2 with what is given, the rest as in the photographs") {
  const MeasuredFlare flare = mirrored_disc();
  CHECK(*exposure_scale(flare, {}) == 1.0);
  CHECK(*exposure_scale(flare, values_with({{"iso", "400"}})) == test::approx(4.0));
  CHECK(*exposure_scale(flare, values_with({{"fnumber", "4"}})) == test::approx(0.25));
  CHECK(*exposure_scale(flare, values_with({{"fnumber", "1"}, {"shutter", "1/8"}})) == test::approx(0.5));
  MeasuredFlare unexposed = flare;
  unexposed.exposure.reset();
  CHECK(*exposure_scale(unexposed, {}) == 1.0);
  CHECK(!exposure_scale(unexposed, values_with({{"iso", "400"}})));
}

TEST_CASE("measured settings: a photograph's light has its ghost where the flare says, with its flux") {
  const MeasuredFlare flare = mirrored_disc();
  Image plate(120, 80);
  plate.at(90, 20, 0) = plate.at(90, 20, 1) = plate.at(90, 20, 2) = 1000.0F;
  const Picture picture = picture_of(plate);
  const auto plan = plan_flare(picture, ideal_lens_of(flare), {});
  REQUIRE(plan.has_value());
  REQUIRE(plan->lights.size() == 1);
  const auto drawn = render_flare(*plan, picture.rgb, flare);
  REQUIRE(drawn.has_value());
  double sum = 0.0, x_sum = 0.0, y_sum = 0.0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 120; ++x) {
      const auto value = static_cast<double>(drawn->image.at(x, y, 1));
      sum += value;
      x_sum += value * (x + 0.5);
      y_sum += value * (y + 0.5);
    }
  }
  CHECK(x_sum / sum == test::approx(120.0 - 90.5).epsilon(1e-3));
  CHECK(y_sum / sum == test::approx(80.0 - 20.5).epsilon(1e-3));
  CHECK(sum == test::approx(1000.0 * 0.0314159).epsilon(0.01));
  CHECK(drawn->visibility.brightest > 0.0);
  const auto dark = plan_flare(picture_of(Image(120, 80)), ideal_lens_of(flare), {});
  CHECK(render_flare(*dark, Image(120, 80), flare)->image.pixels == Image(120, 80).pixels);
}
