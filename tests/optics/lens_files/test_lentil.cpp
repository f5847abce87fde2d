// SPDX-License-Identifier: Apache-2.0
// Lentil's database.
#include <map>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::lentil {
namespace {

const std::string kSample = R"({
 "0001": {"company": "zeiss", "product-name": "small", "patent-number": "DE1", "focal-length-mm-patent": 60,
  "optical-elements-adjusted": [],
  "optical-elements-patent": [
   {"radius": 50, "thickness": 5, "material": "abbe", "ior": 1.5168, "abbe": 64.2, "housing-radius": 12,
    "lens-geometry": "spherical", "aspherical-equation": null},
   {"radius": -200, "thickness": 2, "material": "air", "ior": null, "abbe": null, "housing-radius": 12,
    "lens-geometry": "aspherical", "aspherical-equation": [1e-6, -2e-9]},
   {"radius": 99999.0, "thickness": 2, "material": "IRIS", "ior": null, "abbe": null, "housing_radius": 8,
    "lens-geometry": "spherical", "aspherical-equation": null},
   {"radius": 99999.0, "thickness": 2, "material": "SF5", "ior": null, "abbe": 0, "housing-radius": 9,
    "lens-geometry": "spherical", "aspherical-equation": null},
   {"radius": -80, "thickness": 50, "material": "air", "ior": 1.0, "abbe": 0, "housing-radius": 9,
    "lens-geometry": "planar", "aspherical-equation": null}]},
 "0002": {"company": null, "product-name": "part", "optical-elements-patent": [
   {"radius": 50, "thickness": 5, "material": "air", "housing-radius": 12, "lens-geometry": "cyl-x"}]}
})";

Prescription read_key(const std::string& text, const std::string& key) {
  const auto lens = read_json_lens({text, "a file", nullptr, key});
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  return *lens;
}

void check_refused(const std::string& text, const std::string& key, int line, const std::string& words) {
  const auto lens = read_json_lens({text, "a file", nullptr, key});
  CAPTURE(words);
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().to_string());
  CHECK(lens.error().message.find(words) != std::string::npos);
  CHECK(lens.error().position.line == line);
}

std::string edited(std::string_view from, std::string_view to) { return replaced(kSample, from, to); }

}  // namespace

TEST_CASE("a lens of Lentil's database in every detail") {
  const Prescription lens = read_key(kSample, "0001");
  CHECK(lens.name == "zeiss small (0001)");
  CHECK(lens.source == "DE1");
  CHECK(lens.stated.focal_length_mm == 60.0);
  CHECK(lens.stated.back_focal_distance_mm == 50.0);
  REQUIRE(lens.surfaces.size() == 5);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 50.0);
  CHECK(s[0].semi_diameter_mm == 12.0);
  CHECK(s[0].source_line == 5);
  CHECK(s[0].glass_after == Glass{"", AbbeGlass{1.5168, 64.2}});
  CHECK(is_air(s[1].glass_after));
  CHECK(s[1].shape.powers == std::vector<double>{0, 0, 0, 1e-6, 0, -2e-9});
  CHECK(s[2].kind == SurfaceKind::Stop);
  CHECK(s[2].semi_diameter_mm == 8.0);
  CHECK(s[3].curvature_per_mm == 0.0);
  CHECK(s[3].glass_after.name == "SF5");  // without an index: the catalogue's
  CHECK(refractive_index(s[3].glass_after, kLineD_nm) == test::approx(1.6727).epsilon(1e-4));
  CHECK(s[4].curvature_per_mm == 0.0);
  CHECK(lens.f_number > 3.0);  // that of the iris's full opening
  check_round_trip(lens);
}

TEST_CASE("cylinders of Lentil") {
  const std::string text = replaced(edited("\"planar\"", "\"cyl-x\""),
                                    "\"spherical\", \"aspherical-equation\": null},\n   {\"radius\": -200",
                                    "\"cyl-y\", \"aspherical-equation\": null},\n   {\"radius\": -200");
  const Prescription lens = read_key(text, "0001");
  CHECK(lens.surfaces[0].curvature_per_mm == 0.0);
  CHECK(lens.surfaces[0].shape.kind == ShapeKind::Toroid);
  CHECK(lens.surfaces[0].shape.curvature_x_per_mm == 1.0 / 50.0);
  CHECK(lens.surfaces[4].curvature_per_mm == -1.0 / 80.0);
  CHECK(lens.surfaces[4].shape.kind == ShapeKind::Toroid);
  CHECK(lens.surfaces[4].shape.curvature_x_per_mm == 0.0);
  CHECK_FALSE(lens.stated.focal_length_mm.has_value());
  CHECK(lens.warnings.at(0).find("one section") != std::string::npos);
  check_round_trip(lens);
}

TEST_CASE("what is wrong with a lens of Lentil, and where") {
  check_refused(kSample, "", 0, "2 lenses; name one as FILE#KEY, with a key of 0001, 0002");
  check_refused(kSample, "0003", 0, "no lens has the key '0003'; there are 0001, 0002");
  check_refused(kSample, "0002", 16, "no surface is the stop, and the lens has no power");
  check_refused(edited("\"cyl-x\"", "\"dome\""), "0002", 16, "'dome' is not known");
  check_refused(edited("\"thickness\": 5", "\"thickness\": [5, 6, 7]"), "0001", 5, "several thicknesses");
  check_refused(edited("\"radius\": 50", "\"radius\": null"), "0001", 5, "radius: is missing");
  check_refused(edited("\"SF5\"", "\"SF5555\""), "0001", 11, "SF5555");
  check_refused(edited("[1e-6, -2e-9]", "[1e-6, \"x\"]"), "0001", 8, "aspherical-equation[1]: is no number");
  check_refused(edited("\"zeiss\"", "7"), "0001", 2, "company: is no text");
}

TEST_CASE("Lentil's samples") {
  const auto path = shared_data("lenses/lentil/lenses.json");
  if (!path) return;
  // Computed focal lengths of the y-z section; the file's raytraced ones are those of a finite ray.
  const std::map<std::string, double> kLenses = {
      {"0001", 99.940}, {"0002", 99.912}, {"0003", 86.190}, {"0004", 100.059}, {"0005", 15.324}, {"0006", 99.971},
      {"0007", 25.959}, {"0008", 53.349}, {"0009", 99.914}, {"0010", 100.005}, {"0011", 100.0},  {"0012", 122.179},
      {"0013", 100.2},  {"0014", 9.709},  {"0015", 1.0},    {"0016", 1.001},   {"2001", 8.967},  {"2003", 103.445},
      {"2004", 60.555}, {"9992", 99.940}, {"9993", 99.940}};
  for (const auto& [key, focal_mm] : kLenses) {
    CAPTURE(key);
    const auto lens = read_lens(path->string() + "#" + key);
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    CHECK(state->focal_length_mm == test::approx(focal_mm).epsilon(1e-3));
    check_round_trip(*lens);
  }
  check_warns(*read_lens(path->string() + "#9994"), "no surface is the stop");  // a single lens
  for (const char* key : {"2002", "9991"}) {
    const auto lens = find_lens(path->string() + "#" + key);
    REQUIRE_FALSE(lens.has_value());
    CHECK(lens.error().code == ErrorCode::Unsupported);
  }
  const auto all = read_lens(*path);
  REQUIRE_FALSE(all.has_value());
  CHECK(all.error().message.find("24 lenses") != std::string::npos);
}

// oracles/anamorphic_paraxial.json, computed from the same table by another program.
TEST_CASE("Lentil's anamorphic lenses: both focal lengths, one focus") {
  const auto path = shared_data("lenses/lentil/lenses.json");
  if (!path) return;
  const auto check = [&](const char* key, double focal_y, double back_y, double focal_x, double back_x) {
    const auto lens = read_lens(path->string() + "#" + key);
    REQUIRE(lens.has_value());
    const auto state = configure_lens(*lens);
    REQUIRE(state.has_value());
    const FirstOrder figures = first_order(*state, kLineD_nm);
    CHECK(std::abs(figures.focal_length_mm - focal_y) < 6e-4);
    CHECK(std::abs(figures.back_focal_distance_mm - back_y) < 6e-4);
    CHECK(std::abs(figures.focal_length_x_mm - focal_x) < 6e-4);
    CHECK(std::abs(figures.back_focal_distance_x_mm - back_x) < 6e-4);
  };
  check("2004", 60.555, 43.355, 31.488, 43.33);
  check("2003", 103.445, 39.094, 141.751, 41.884);
  check("2001", 8.967, 9.855, 4.011, -2.219);
}

TEST_CASE("a key for a file with one lens") {
  const auto path = shared_data("lenses/realflare/model/Kodak/100mm.json");
  if (!path) return;
  const auto lens = read_lens(path->string() + "#1");
  REQUIRE_FALSE(lens.has_value());
  CHECK(lens.error().message.find("leave '#1' out") != std::string::npos);
}

}  // namespace contrejour::test::lentil
