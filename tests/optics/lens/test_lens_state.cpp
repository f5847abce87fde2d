// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

Glass crown() { return {"crown", AbbeGlass{1.5168, 64.17}}; }

// Two separated positive lenses with a variable gap as the zoom.
Prescription zoom_lens() {
  Prescription lens;
  lens.name = "pair";
  lens.f_number = 4.0;
  lens.surfaces = {{SurfaceKind::Refracting, 1.0 / 80.0, 4.0, 15.0, crown(), {}, 0},
                   {SurfaceKind::Refracting, -1.0 / 80.0, 10.0, 15.0, air(), {}, 0},
                   {SurfaceKind::Stop, 0.0, 5.0, 8.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 1.0 / 90.0, 3.0, 12.0, crown(), {}, 0},
                   {SurfaceKind::Refracting, -1.0 / 90.0, 0.0, 12.0, air(), {}, 0}};
  lens.zoom = {{45.0, {{1, 5.0}}, 0}, {55.0, {{1, 40.0}}, 0}};
  return lens;
}

Prescription prime_lens() {
  Prescription lens = zoom_lens();
  lens.zoom.clear();
  return lens;
}

}  // namespace

TEST_CASE("the two-term fit passes through n_d and the F and C lines") {
  const Glass g = crown();
  CHECK(refractive_index(g, kLineD_nm) == test::approx(1.5168).epsilon(1e-14));
  const double spread = refractive_index(g, kLineF_nm) - refractive_index(g, kLineC_nm);
  CHECK((1.5168 - 1.0) / spread == test::approx(64.17).epsilon(1e-12));
}

TEST_CASE("Sellmeier's formula gives N-BK7's catalogue index at d") {
  // Schott, N-BK7 data sheet: n_d = 1.51680.
  const Glass bk7{"N-BK7", Sellmeier{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}};
  CHECK(refractive_index(bk7, kLineD_nm) == test::approx(1.51680003).epsilon(1e-8));
}

TEST_CASE("any focal length between a zoom's positions is reached, and the sensor follows focus") {
  const Prescription lens = zoom_lens();
  const double shortest = configure_lens(lens, {.focal_length_mm = 45.0})->focal_length_mm;
  const double longest = configure_lens(lens, {.focal_length_mm = 55.0})->focal_length_mm;
  REQUIRE(longest > shortest + 5.0);
  for (int k = 1; k < 10; ++k) {
    const double wanted = shortest + (longest - shortest) * k / 10.0;
    const auto state = configure_lens(lens, {.focal_length_mm = wanted});
    REQUIRE(state.has_value());
    CHECK(state->focal_length_mm == test::approx(wanted).epsilon(1e-9));
    const FirstOrder f = first_order(*state, kLineD_nm);
    CHECK(f.sensor_position_mm == test::approx(f.back_focal_distance_mm).epsilon(1e-12));
  }
  CHECK_FALSE(configure_lens(lens, {.focal_length_mm = 20.0}).has_value());
  CHECK_FALSE(configure_lens(lens, {.focal_length_mm = 500.0}).has_value());
  CHECK_FALSE(configure_lens(lens, {.focal_length_mm = std::nan("")}).has_value());
}

TEST_CASE("the f-number sets the stop by the real marginal ray") {
  const auto f8 = configure_lens(prime_lens(), {.f_number = 8.0});
  const auto f16 = configure_lens(prime_lens(), {.f_number = 16.0});
  REQUIRE(f8.has_value());
  REQUIRE(f16.has_value());
  CHECK(f8->stop_radius_mm / f16->stop_radius_mm == test::approx(2.0).epsilon(0.01));
  // Paraxially the marginal height at the stop is front.a * EPD / 2; the real ray differs only by aberration.
  const Abcd front = abcd_between(f16->surfaces, 0, f16->stop_index, kLineD_nm);
  CHECK(f16->stop_radius_mm == test::approx(front.a * f16->focal_length_mm / 32.0).epsilon(1e-3));
  CHECK(configure_lens(prime_lens(), {.f_number = 3.9})->f_number == 4.0);  // engraved slightly wider than it is
  Prescription narrow = prime_lens();
  narrow.surfaces[2].semi_diameter_mm = 2.0;
  const auto clipped = configure_lens(narrow, {.f_number = 4.0});
  CHECK(clipped->stop_radius_mm == 2.0);
  CHECK(clipped->f_number > 8.0);
  CHECK(clipped->warnings.size() == 1);
  CHECK_FALSE(configure_lens(prime_lens(), {.f_number = 0.5}).has_value());
  CHECK_FALSE(configure_lens(prime_lens(), {.f_number = -8.0}).has_value());
  CHECK_FALSE(configure_lens(prime_lens(), {.f_number = std::nan("")}).has_value());
}

TEST_CASE("focusing near moves the sensor to the conjugate plane (Newton's equation)") {
  const auto far = configure_lens(prime_lens(), {});
  const auto near = configure_lens(prime_lens(), {.object_distance_mm = 1000.0});
  REQUIRE(near.has_value());
  const FirstOrder f = first_order(*far, kLineD_nm);
  const double x = 1000.0 + f.front_focal_distance_mm;  // object to front focal point
  CHECK(near->sensor_z_mm - far->sensor_z_mm == test::approx(f.focal_length_mm * f.focal_length_mm / x).epsilon(1e-9));
  CHECK_FALSE(configure_lens(prime_lens(), {.object_distance_mm = 10.0}).has_value());
  CHECK_FALSE(configure_lens(prime_lens(), {.object_distance_mm = -5.0}).has_value());
}

TEST_CASE("what has no image says which objects have one") {
  const auto message = [](const Prescription& lens, double object_mm) {
    const auto state = configure_lens(lens, {.object_distance_mm = object_mm});
    REQUIRE_FALSE(state.has_value());
    return state.error().message;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  CHECK(message(prime_lens(), 10.0).find("focus farther away than its front focal point at") != std::string::npos);
  Prescription negative = prime_lens();
  for (Surface& surface : negative.surfaces) surface.curvature_per_mm *= -1.0;
  CHECK(message(negative, kInfinity).find("nor of any other, as its focal length is -") != std::string::npos);
  CHECK(message(negative, 500.0).find("nor of any other") != std::string::npos);
  // A second lens beyond the first one's focus: distant objects are in focus in front of it, near ones behind.
  Prescription relay = prime_lens();
  relay.surfaces.back().thickness_mm = 45.0;
  for (Surface surface : prime_lens().surfaces) {
    if (surface.kind == SurfaceKind::Stop) surface.kind = SurfaceKind::Refracting;
    relay.surfaces.push_back(surface);
  }
  const auto far = configure_lens(relay);
  REQUIRE_FALSE(far.has_value());
  const std::string text = far.error().message;
  double min_mm = 0.0, max_mm = 0.0;
  const std::size_t from = text.find("only objects from ");
  REQUIRE(from != std::string::npos);
  REQUIRE(std::sscanf(text.c_str() + from, "only objects from %lf to %lf mm", &min_mm, &max_mm) == 2);
  CHECK(configure_lens(relay, {.object_distance_mm = min_mm + 0.1 * (max_mm - min_mm)}).has_value());
  CHECK(configure_lens(relay, {.object_distance_mm = max_mm - 1.0}).has_value());
  CHECK_FALSE(configure_lens(relay, {.object_distance_mm = max_mm + 1.0}).has_value());
}

TEST_CASE("a coating setting replaces glass-to-air coatings only") {
  Prescription lens = prime_lens();
  lens.surfaces[0].glass_after = crown();
  const Coating blue{"", QuarterWave{1.38, 430.0}};
  const auto state = configure_lens(lens, {.coating = blue});
  REQUIRE(state.has_value());
  CHECK(state->surfaces[0].coating == blue);
  CHECK(state->surfaces[1].coating == blue);
  CHECK(state->surfaces[2].coating == Coating{});  // the stop
}

TEST_CASE("figures that the source states and the surfaces do not have are warnings, at the first position alone") {
  auto zoom = find_lens("canon-70-200");
  REQUIRE(zoom.has_value());
  zoom->stated.focal_length_mm = 75.0;
  zoom->stated.back_focal_distance_mm = 40.0;
  const auto wide = configure_lens(*zoom);
  REQUIRE(wide.has_value());
  REQUIRE(wide->warnings.size() == 2);
  CHECK(wide->warnings[0] == "its source states a focal length of 75 mm; the surfaces have 72.12 mm");
  CHECK(wide->warnings[1].find("back focal distance of 40 mm") != std::string::npos);
  const auto far = configure_lens(*zoom, {.focal_length_mm = 200.0});
  REQUIRE(far.has_value());
  CHECK(far->warnings.empty());
  zoom->stated.back_focal_distance_mm = 52.45;
  REQUIRE(configure_lens(*zoom)->warnings.size() == 1);
  CHECK(configure_lens(*zoom)->warnings[0] ==
        "its source states a focal length of 75 mm; the surfaces have 72.12 mm, and the stated back focal distance");
  zoom->stated.tolerance = 0.2;
  CHECK(configure_lens(*zoom)->warnings.empty());
}
