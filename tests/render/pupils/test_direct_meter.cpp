// SPDX-License-Identifier: Apache-2.0
// The direct image's pupil, found at one wavelength and used for others.
#include <doctest/doctest.h>

#include "render/pupils/direct_meter.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

struct Case {
  const char* lens;
  double f_number;
  Vec2 uv;
};

// Stopped down, vignetted, wide open at the corner, with an aspherical front; the last is a fisheye at the edge.
constexpr Case kCases[] = {{"heliar", 16.0, {0.7, 0.33}},
                           {"nikon-80-200", 2.97, {0.9, 0.9}},
                           {"canon-rf-50", 1.4, {0.2, 0.8}},
                           {"muller-fisheye-10", 8.0, {0.95, 0.5}}};

}  // namespace

TEST_CASE("a wavelength's direct flux is the same in another one's pupil") {
  for (const Case& c : kCases) {
    CAPTURE(c.lens);
    const LensState lens = test::bundled(c.lens, {.f_number = c.f_number});
    const Light light = test::light_at(lens, frame_on_sensor(lens, 60, 40), c.uv);
    const DirectMeter meter(lens, light.source());
    const ReflectanceTables green(lens, 550.0);
    const auto pupil = meter.pupil(green);
    REQUIRE(pupil.has_value());
    for (const double lambda_nm : {400.0, 550.0, 700.0}) {
      CAPTURE(lambda_nm);
      const ReflectanceTables tables(lens, lambda_nm);
      const double own = meter.flux_mm2(tables);
      CHECK(own > 0.0);
      CHECK(meter.flux_mm2(tables, *pupil) == test::approx(own).epsilon(2e-4));
      // A box that cuts off some of the pupil, on any side, is extended.
      const Vec2 some = (pupil->high - pupil->low) * 0.3;
      for (const Rectangle& part :
           {Rectangle{pupil->low + some, pupil->high}, Rectangle{pupil->low, pupil->high - some},
            Rectangle{pupil->low + some, pupil->high - some}})
        CHECK(meter.flux_mm2(tables, part) == test::approx(own).epsilon(5e-4));
    }
  }
}

// The pupil is as small as a cell of the search's first grid. Without extension, the flux varied between 0.49 and 1 of
// this from angle to angle, so that ghosts flashed as a light moved.
TEST_CASE("the direct flux of a fisheye changes steadily over the field") {
  const LensState lens = test::bundled("muller-fisheye-10", {.f_number = 8.0});
  const ReflectanceTables tables(lens, 550.0);
  double before = 0.0;
  for (double angle_rad = 0.0; angle_rad < 1.2; angle_rad += 0.02) {
    CAPTURE(angle_rad);
    const double flux =
        DirectMeter(lens, LightSource{direction_from_angles(0.85 * angle_rad, 0.53 * angle_rad)}).flux_mm2(tables);
    if (before > 0.0) CHECK(flux == test::approx(before).epsilon(0.03));
    before = flux;
  }
}

TEST_CASE("where nothing gets through there is no pupil and no flux") {
  const LensState lens = test::bundled("nikon-80-200", {.f_number = 16.0});
  const LightSource behind_rims{direction_from_angles(1.3, 0.0)};
  const DirectMeter meter(lens, behind_rims);
  const ReflectanceTables tables(lens, 550.0);
  CHECK_FALSE(meter.pupil(tables).has_value());
  CHECK(meter.flux_mm2(tables) == 0.0);
}
