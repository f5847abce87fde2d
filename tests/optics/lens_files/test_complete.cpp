// SPDX-License-Identifier: Apache-2.0
// Completes what files of other programs leave open: rims that do not cross, semi-diameters from a beam, f-numbers.
#include "optics/lens_files/complete.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/plain_number.h"
#include "support/approx.h"

namespace contrejour::test::complete {
namespace {

// A biconvex lens of 100 mm radii, n = 1.5, 4 mm thick, f near 100 mm, and a stop 5 mm behind it.
Prescription singlet(double lens_mm, double stop_mm) {
  Prescription lens;
  lens.name = lens.source = "x";
  Surface front{.curvature_per_mm = 0.01, .thickness_mm = 4.0, .semi_diameter_mm = lens_mm};
  front.glass_after = Glass{"", ConstantIndex{1.5}};
  Surface back{.curvature_per_mm = -0.01, .thickness_mm = 5.0, .semi_diameter_mm = lens_mm};
  Surface stop{.kind = SurfaceKind::Stop, .semi_diameter_mm = stop_mm};
  lens.surfaces = {front, back, stop};
  return lens;
}

// The height at which two spheres of 100 mm radius meet whose vertices are 4 mm apart: sag = 2 mm.
const double kMeeting_mm = std::sqrt(100.0 * 100.0 - 98.0 * 98.0);

}  // namespace

TEST_CASE("rims that cross shrink to where they meet, and a warning says so") {
  auto lens = singlet(20.5, 5.0);
  lens.surfaces[0].source_line = 7;
  const auto whole = completed(lens);
  REQUIRE(whole);
  for (const std::size_t k : {0u, 1u})
    CHECK(whole->surfaces[k].semi_diameter_mm == test::approx(kMeeting_mm).epsilon(1e-9));
  REQUIRE(whole->warnings.size() == 2);
  CHECK(whole->warnings[0].find("surface 1 (line 7)") != std::string::npos);
  CHECK(configure_lens(*whole)->warnings.size() == 2);

  lens.surfaces[0].semi_diameter_mm = 30.0;  // the smaller is enough
  const auto one = completed(lens);
  REQUIRE(one);
  CHECK(one->surfaces[0].semi_diameter_mm == 30.0);
  CHECK(one->warnings.size() == 1);
}

TEST_CASE("rims that cross by much are errors in the radii or thicknesses") {
  const auto lens = completed(singlet(27.0, 5.0));
  REQUIRE_FALSE(lens);
  CHECK(lens.error().message.find("it crosses surface 1") != std::string::npos);
}

TEST_CASE("surfaces in contact whose radii differ a little are parted by as little") {
  auto lens = singlet(20.0, 5.0);
  Surface behind{.curvature_per_mm = -0.0101, .thickness_mm = 5.0, .semi_diameter_mm = 8.0};  // 0.0033 mm at the rim
  behind.glass_after = Glass{"", ConstantIndex{1.6}};
  Surface last{.curvature_per_mm = 0.0, .thickness_mm = 5.0, .semi_diameter_mm = 8.0};
  lens.surfaces[0].semi_diameter_mm = lens.surfaces[1].semi_diameter_mm = 8.0;
  lens.surfaces[1].thickness_mm = 0.0;
  lens.surfaces.insert(lens.surfaces.begin() + 2, {behind, last});
  const auto whole = completed(lens);
  REQUIRE_MESSAGE(whole.has_value(), (whole ? "" : whole.error().to_string()));
  CHECK(whole->surfaces[1].semi_diameter_mm == 8.0);
  CHECK(whole->surfaces[1].thickness_mm > 0.003);
  CHECK(whole->surfaces[1].thickness_mm < 0.004);
  REQUIRE(whole->warnings.size() == 1);
  CHECK(whole->warnings[0].find("surfaces 2 and 3") != std::string::npos);
  lens.surfaces[2].curvature_per_mm = -0.02;  // 0.3 mm: an error
  CHECK_FALSE(completed(lens).has_value());
}

TEST_CASE("a sphere drawn beyond its own radius ends there") {
  auto lens = singlet(19.0, 5.0);
  lens.surfaces[0].curvature_per_mm = 1.0 / 18.0;
  lens.surfaces[0].thickness_mm = 20.0;
  lens.surfaces[1].curvature_per_mm = 0.0;
  const auto whole = completed(lens);
  REQUIRE(whole);
  CHECK(whole->surfaces[0].semi_diameter_mm == test::approx(18.0));
  CHECK(whole->surfaces[0].semi_diameter_mm <= 18.0);
}

TEST_CASE("a rim that fits is left alone") {
  const auto whole = completed(singlet(19.0, 5.0));
  REQUIRE(whole);
  CHECK(whole->surfaces[0].semi_diameter_mm == 19.0);
  CHECK(whole->warnings.empty());
}

TEST_CASE("an f-number that is not given is the stop's") {
  const auto whole = completed(singlet(19.0, 5.0));
  REQUIRE(whole);
  const auto state = configure_lens(*whole);
  REQUIRE(state);
  CHECK(state->warnings.empty());
  CHECK(state->stop_radius_mm == test::approx(5.0).epsilon(1e-6));
  // Thin lens: the pupil is the stop's 10 mm, larger by f / (f - 7).
  CHECK(whole->f_number == test::approx(100.0 / (10.0 * 100.0 / 93.0)).epsilon(0.02));
}

TEST_CASE("semi-diameters that are not given are those of the beam") {
  auto lens = singlet(0.0, 0.0);
  lens.surfaces[0].semi_diameter_mm = 15.0;  // given: unchanged
  const double field_rad = 0.05, pupil_mm = 10.0;
  lens.f_number = 10.0;
  const auto whole = completed(lens, Beam{pupil_mm, field_rad});
  REQUIRE(whole);
  CHECK(whole->surfaces[0].semi_diameter_mm == 15.0);
  CHECK(whole->warnings.empty());
  const auto state = configure_lens(*whole);
  REQUIRE(state);
  CHECK(state->f_number == test::approx(10.0));
  // At the back of a thin lens 5 mm before the stop: the axial beam's 5 mm and the chief ray's 5 mm * tan(field).
  CHECK(whole->surfaces[1].semi_diameter_mm == test::approx(5.0 + 5.0 * std::tan(field_rad)).epsilon(0.03));
  CHECK(state->stop_radius_mm == test::approx(whole->surfaces[2].semi_diameter_mm));
  CHECK(state->stop_radius_mm == test::approx(5.0 * 0.93).epsilon(0.02));
}

TEST_CASE("semi-diameters that are not given, and no beam, are an error with the position") {
  auto lens = singlet(19.0, 0.0);
  lens.surfaces[2].source_line = 9;
  const auto whole = completed(lens);
  REQUIRE_FALSE(whole);
  CHECK(whole.error().position.line == 9);
}

TEST_CASE("a lens without a stop, without surfaces, without power") {
  auto no_stop = singlet(10.0, 5.0);
  no_stop.surfaces.pop_back();
  CHECK_FALSE(completed(no_stop));
  no_stop.surfaces[0].semi_diameter_mm = 0.0;
  CHECK_FALSE(completed(no_stop, Beam{10.0, 0.1}));
  CHECK_FALSE(completed(Prescription{}));
  auto flat = singlet(10.0, 0.0);
  for (Surface& s : flat.surfaces) s.curvature_per_mm = 0.0;
  CHECK_FALSE(completed(flat, Beam{10.0, 0.1}));
}

TEST_CASE("numbers as lens files write them") {
  CHECK(plain_number("1.5") == 1.5);
  CHECK(plain_number("+1.5") == 1.5);
  CHECK(plain_number("1.5D-3") == 1.5e-3);
  CHECK(plain_number(".5") == 0.5);
  CHECK(plain_number("1e-400") == 0.0);
  CHECK_FALSE(std::signbit(*plain_number("-0")));
  for (const char* none : {"", "+", "++1", "1.5x", "inf", "nan", "1e10", "1e400", "--1", " 1"}) {
    CAPTURE(none);
    CHECK_FALSE(plain_number(none));
  }
  CHECK(curvature_of_radius(0.0) == 0.0);
  CHECK(curvature_of_radius(std::numeric_limits<double>::infinity()) == 0.0);
  CHECK(curvature_of_radius(-4.0) == -0.25);
  CHECK(tidy_curvature(1e-12) == 0.0);
  CHECK(tidy_curvature(1e-3) == 1e-3);
}

}  // namespace contrejour::test::complete
