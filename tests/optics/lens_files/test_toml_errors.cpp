// SPDX-License-Identifier: Apache-2.0
// Each error by its exact position and words: file:line: what is wrong and what to do.
#include "optics/lens_files/sample_lens.h"

#include <cmath>

#include <fmt/format.h>

#include "contrejour/lens.h"
#include "support/approx.h"

namespace contrejour::test::toml_errors {
namespace {

// The text's error must begin with "x.toml:LINE: " and contain `words`.
void check_error(const std::string& text, int line, const std::string& words) {
  const auto lens = read_lens_toml(text, "x.toml");
  REQUIRE_FALSE(lens.has_value());
  const std::string message = lens.error().to_string();
  CAPTURE(message);
  CHECK(message.starts_with(fmt::format("x.toml:{}: ", line)));
  CHECK(message.find(words) != std::string::npos);
}

void check_edit(const std::string& from, const std::string& to, int line, const std::string& words) {
  check_error(edited(from, to), line, words);
}

TEST_CASE("the sample itself is correct") {
  const auto lens = read_lens_toml(kSampleLens, "x.toml");
  if (!lens) MESSAGE(lens.error().to_string());
  REQUIRE(lens.has_value());
  CHECK(read_lens_toml(zoom_sample(), "x.toml").has_value());
}

TEST_CASE("unknown keys name the nearest known one") {
  check_edit("radius_mm = 50.0", "radius = 50.0", 6, "unknown key 'radius'; did you mean 'radius_mm'?");
  check_edit("f_number", "f_nubmer", 3, "did you mean 'f_number'?");
  check_edit("focal_length_mm", "wibble", 13, "stated: unknown key 'wibble'; known are focal_length_mm");
  check_edit("v_d = 33.85", "abbe = 33.85", 16, "glass 'SF2': unknown key 'abbe'; known are");
  check_edit("\"BK7\" },", "\"BK7\", zzz = 1 },", 6, "surface 1: unknown key 'zzz'; known are radius_mm");
}

TEST_CASE("missing keys") {
  check_edit("name = \"Sample\"\n", "", 1, "lens: name is missing; give the lens a name");
  check_edit("source = \"none\"", "source = \"\"", 2, "source is empty; say where");
  check_edit("f_number = 4.0", "", 1, "f_number is missing");
  check_edit("sensor_mm = [36, 24]", "", 1, "give the sensor either as sensor_mm");
  check_edit("radius_mm = 50.0, ", "", 6, "surface 1: give either radius_mm (inf for a plane)");
  check_edit("thickness_mm = 5.0, ", "", 6, "surface 1: thickness_mm is missing; give the distance");
  check_edit(", semi_diameter_mm = 9.0 },\n]", " },\n]", 10, "surface 5: semi_diameter_mm is missing");
  check_error("name = \"a\"\nsource = \"b\"\nf_number = 2\nsensor_mm = [3, 2]\n", 1, "surfaces is missing");
  check_error("name = \"a\"\nsource = \"b\"\nf_number = 2\nsensor_mm = [3, 2]\nsurfaces = []\n", 5,
              "surfaces is empty");
}

TEST_CASE("wrong types") {
  check_edit("f_number = 4.0", "f_number = \"4\"", 3, "f_number must be a number, not text");
  check_edit("name = \"Sample\"", "name = 3", 1, "name must be text in quotes, not a whole number");
  check_edit("thickness_mm = 3.0", "thickness_mm = [3.0]", 7, "surface 2: thickness_mm must be a number, not a list");
  check_edit("stop = true", "stop = 1", 8, "stop must be true or false");
  check_edit("stop = true", "stop = false", 8, "stop = false says nothing");
  check_edit("glass = \"BK7\"", "glass = 1.5", 6, "surface 1: glass must be a name in quotes or {");
  check_edit("sensor_mm = [36, 24]", "sensor_mm = 36", 4, "sensor_mm must be a list");
  check_edit("sensor_mm = [36, 24]", "sensor_mm = [36, 24]\nsensor_distance_mm = -3", 5, "sensor_distance_mm is -3");
  check_edit("sensor_mm = [36, 24]", "sensor_mm = [36]", 4, "sensor_mm must be [width, height]");
  check_edit("  { radius_mm = 70.0, semi_diameter_mm = 9.0 },", "  70.0,", 10, "surface 5 must be a row");
  check_edit("[stated]\n", "stated = 3\n#", 12, "stated must be a table");
  check_edit("[glass]\n", "[glass]\nX = 1\n", 15, "glass 'X' must be a table in braces");
}

TEST_CASE("numbers that are no lengths") {
  check_edit("radius_mm = 50.0", "radius_mm = 0", 6, "radius_mm is 0; write radius_mm = inf for a plane");
  check_edit("radius_mm = 50.0", "radius_mm = nan", 6, "surface 1: radius_mm is nan");
  check_edit("radius_mm = 50.0", "radius_mm = 9.0", 6, "radius 9 mm is smaller than semi_diameter_mm 10");
  check_edit("radius_mm = 50.0", "curvature_per_mm = 0.02, radius_mm = 50.0", 6, "give either radius_mm");
  check_edit("thickness_mm = 5.0", "thickness_mm = inf", 6, "thickness_mm is inf");
  check_edit("thickness_mm = 5.0", "thickness_mm = -5.0", 6, "surface 1: thickness_mm is -5; give the distance");
  check_edit("semi_diameter_mm = 6.0", "semi_diameter_mm = 0", 8, "surface 3: semi_diameter_mm is 0; give");
  check_edit("semi_diameter_mm = 6.0", "semi_diameter_mm = -6", 8, "semi_diameter_mm is -6; give");
  check_edit("semi_diameter_mm = 6.0", "semi_diameter_mm = nan", 8, "semi_diameter_mm is nan");
  check_edit("f_number = 4.0", "f_number = nan", 3, "f_number is nan");
  check_edit("f_number = 4.0", "f_number = 0", 1, "f_number is 0; give the widest");
  check_edit("[36, 24]", "[36, 0]", 4, "the sensor's height is 0");
  check_edit("focal_length_mm = 60.0", "focal_length_mm = inf", 13, "stated: focal_length_mm is inf");
  check_edit("radius_mm = 70.0, semi", "radius_mm = 70.0, thickness_mm = 40.0, semi", 10,
             "the last surface has no thickness_mm");
  // A whole number that no double represents exactly.
  check_edit("thickness_mm = 5.0", "thickness_mm = 9007199254740993", 6, "thickness_mm is");
}

TEST_CASE("glasses") {
  check_edit("glass = \"BK7\"", "glass = \"BK7x\"", 6, "no glass is called 'BK7x'; did you mean 'BK7'?");
  check_edit("glass = \"BK7\"", "glass = \"marble\"", 6, "no glass is called 'marble'");
  check_edit("glass = \"BK7\"", "glass = \"marble\"", 6, "add it under [glass]");
  check_edit("n_d = 1.5168", "n_d = 0.9", 15, "glass 'BK7': the glass's index is 0.8");
  check_edit("n_d = 1.5168", "n_d = 15.168", 15, "it must be from 1 to 5");
  check_edit("v_d = 64.17", "v_d = -3", 15, "v_d is -3; an Abbe number is from 5 to 200");
  check_edit("v_d = 64.17", "v_d = nan", 15, "v_d is nan");
  check_edit(", v_d = 64.17", "", 15, "v_d is missing");
  check_edit("v_d = 64.17", "n = 1.5", 15, "glass 'BK7': give a glass either n_d and v_d, or n alone");
  check_edit("n_d = 1.5168, v_d = 64.17", "sellmeier_b = [1, 2]", 15, "sellmeier_b must be a list of three numbers");
  check_edit("n_d = 1.5168, v_d = 64.17", "sellmeier_b = [1, 0, 0], sellmeier_c_um2 = [0.3, 0, 0]", 15,
             "sellmeier_c_um2 has 0.3; give squares of wavelengths (um^2) outside the visible");
  check_edit("[glass]\n", "[glass]\nair = { n = 1.0 }\n", 15, "this name has a meaning already");
  check_edit("[glass]\n", "[glass]\nX = { n = 1.7 }\n", 15, "glass 'X' is used by no surface");
  check_edit("radius_mm = 70.0,", "radius_mm = 70.0, glass = \"BK7\",", 10, "the last surface must be followed by air");
}

TEST_CASE("coatings") {
  const auto coated = [](const std::string& coating) { return fmt::format("glass = \"BK7\", coating = {}", coating); };
  const auto check = [&](const std::string& coating, const std::string& words) {
    check_edit("glass = \"BK7\"", coated(coating), 6, words);
  };
  check("\"quater-wave\"", "no coating is called 'quater-wave'");
  check("5", "coating must be a name in quotes or {");
  check("{ design = \"x-coat\" }", "no design is called 'x-coat'");
  check("{ design = \"v-coat\", design_nm = 50 }", "a wavelength from 100");
  check("{ design = \"v-coat\", n = 1.4 }", "give a coating one of");
  check("{ design_nm = 500 }", "give a coating one of");
  check("{ layers = [{ material = \"MgF\", thickness_nm = 9 }] }", "did you mean 'MgF2'?");
  check("{ layers = [{ material = \"MgF2\", n = 1.38, thickness_nm = 9 }] }", "either a material or n and k");
  check("{ layers = [{ n = 1.38, thickness_nm = 9, waves = 0.25 }] }", "either thickness_nm or waves");
  check("{ layers = [{ n = 1.38, thickness_nm = 9, at_nm = 550 }] }", "give waves");
  check("{ layers = [{ n = 0, waves = 1 }] }", "give n from");
  check("{ measured_nm = [500, 400], measured_deg = [0], reflectance = [0, 0] }", "wavelengths must rise");
  check("{ measured_nm = [400], measured_deg = [95], reflectance = [0] }", "within 0 to 90");
  check("{ measured_nm = [400], measured_deg = [0], reflectance = [0, 0] }", "2 reflectances; give 1");
  check("{ measured_nm = [400], measured_deg = [0], reflectance = [1.5] }", "each from 0 to 1");
  check("{ n = 1.38 }", "give a coating one of quarter_wave_nm");
  check("{ quarter_wave_nm = 550, layers = [] }", "give a coating one of quarter_wave_nm");
  check("{ quarter_wave_nm = -550 }", "a film of index 1.38 for -550 nm");
  check("{ quarter_wave_nm = 550, n = 0.5 }", "a film of index 0.5");
  check("{ layers = [] }", "a stack of 0 layers; give 1 to 200");
  check("{ layers = [1] }", "film 1: write a film as");
  check("{ layers = [{ n = 1.4 }] }", "film 1: thickness_nm is missing");
  check("{ layers = [{ n = 1.4, k = -1, thickness_nm = 90 }] }", "a layer of n = 1.4, k = -1, 90 nm");
  check_edit("stop = true", "stop = true, coating = \"none\"", 8, "a stop has no coating; leave it out");
  check_edit("sensor_mm", "default_coating = \"gold\"\nsensor_mm", 4, "default_coating: no coating is called 'gold'");
}

TEST_CASE("the stop") {
  check_edit("stop = true", "radius_mm = inf", 6, "the lens has no stop; add a row { stop = true");
  check_edit("radius_mm = inf", "stop = true", 9, "a stop has no glass");
  check_edit("radius_mm = -60.0", "stop = true", 8, "surface 3: a second stop; keep the one");
  check_edit("stop = true", "stop = true, radius_mm = inf", 8, "a stop has no radius_mm; leave it out");
  check_error(
      "name = \"a\"\nsource = \"b\"\nf_number = 2\nsensor_mm = [3, 2]\nsurfaces = [{ stop = true, "
      "semi_diameter_mm = 1 }]\n",
      5, "a stop alone is no lens");
}

TEST_CASE("surfaces that cross inside their clear aperture") {
  // Sags at 10 mm: 50 mm gives 1.01 mm, -60 mm gives 0.84 mm: 1.85 mm of glass at least.
  check_edit("thickness_mm = 5.0", "thickness_mm = 1.8", 7,
             "surface 2: it crosses surface 1 by 0.0494 mm inside the "
             "clear aperture (at height 10 mm)");
  CHECK(read_lens_toml(edited("thickness_mm = 5.0", "thickness_mm = 1.9"), "x.toml").has_value());
  // Across the stop: surface 2, reversed, bulges into surface 4, though no rim touches the stop's plane.
  const std::string bulge = edited("radius_mm = -60.0", "radius_mm = 12.0");
  check_error(
      edited("thickness_mm = 3.0", "thickness_mm = 0.1", edited("thickness_mm = 2.0", "thickness_mm = 0.1", bulge)), 9,
      "surface 4: it crosses surface 2");
  // A stop's plane may lie within its neighbour's concave side.
  CHECK(read_lens_toml(edited("thickness_mm = 3.0", "thickness_mm = 0.0"), "x.toml").has_value());
}

TEST_CASE("zooms") {
  const std::string zoom = zoom_sample();
  const auto check = [&](const std::string& from, const std::string& to, int line, const std::string& words) {
    check_error(edited(from, to, zoom), line, words);
  };
  check("{ 2 = 3.0 }", "{ 9 = 3.0 }", 13, "zoom position 1: there is no surface '9'; the lens has surfaces 1 to 5");
  check("{ 2 = 3.0 }", "{ 0 = 3.0 }", 13, "there is no surface '0'");
  check("{ 2 = 3.0 }", "{ two = 3.0 }", 13, "there is no surface 'two'");
  check("{ 2 = 3.0 }", "{ 02 = 3.0 }", 13, "there is no surface '02'");
  check("{ 2 = 3.0 }", "{ 5 = 3.0 }", 13, "no gap is behind surface 5; gaps are 1 to 4");
  check("{ 2 = 3.0 }", "{ }", 13, "give each gap that moves, once");
  check("{ 2 = 4.0 }", "{ 3 = 4.0 }", 14, "it moves other gaps than position 1");
  check("{ 2 = 4.0 }", "{ 2 = -4.0 }", 14, "the thickness behind surface 2 is -4");
  check("{ 2 = 4.0 }", "{ 2 = nan }", 14, "thickness_mm is nan");
  check("focal_length_mm = 60,", "focal_length_mm = 40,", 14,
        "40 mm after 50 mm; list the positions from the shortest");
  check("focal_length_mm = 60,", "focal_length_mm = 50,", 14, "50 mm after 50 mm");
  check("focal_length_mm = 60,", "focal_length_mm = -60,", 14, "zoom position 2: focal_length_mm is -60");
  check("  { focal_length_mm = 60, thickness_mm = { 2 = 4.0 } },\n", "", 12, "zoom has 1 positions; give 2 to 200");
  check("thickness_mm = { 2 = 4.0 }", "thickness = { 2 = 4.0 }", 14, "did you mean 'thickness_mm'?");
  // At 60 mm the gap of surface 1 closes; at 50 mm it does not.
  const std::string closing = edited("{ 2 = 4.0 }", "{ 1 = 1.0 }", edited("{ 2 = 3.0 }", "{ 1 = 5.0 }", zoom));
  check_error(closing, 7, "inside the clear aperture (at height 10 mm, zoomed to 60 mm)");
}

TEST_CASE("half field in place of a sensor") {
  const auto lens = read_lens_toml(edited("sensor_mm = [36, 24]", "half_field_deg = 20"), "x.toml");
  REQUIRE(lens.has_value());
  // 60 mm tan 20 degrees = 21.838 mm: the half diagonal.
  CHECK(std::hypot(lens->sensor_width_mm, lens->sensor_height_mm) / 2 == test::approx(21.83821406).epsilon(1e-9));
  CHECK(lens->sensor_width_mm / lens->sensor_height_mm == test::approx(1.5));
  check_edit("sensor_mm = [36, 24]", "sensor_mm = [36, 24]\nhalf_field_deg = 20", 1, "give the sensor either");
  check_edit("sensor_mm = [36, 24]", "half_field_deg = 89", 4, "half_field_deg is 89; give a number from 0.01 to 80");
  check_error(edited("[stated]\nfocal_length_mm = 60.0\n", "", edited("sensor_mm = [36, 24]", "half_field_deg = 20")),
              4, "half_field_deg needs focal_length_mm under [stated]");
}

TEST_CASE("what is no TOML") {
  check_error("name = \n", 1, "not valid TOML");
  check_error("name = \"a\"\nname = \"b\"\n", 2, "not valid TOML");
  check_error("name = \"a\nsource", 1, "not valid TOML");
  check_error(edited("surfaces = [", "surfaces = [") + "x\n", 17, "not valid TOML");
}

}  // namespace
}  // namespace contrejour::test::toml_errors
