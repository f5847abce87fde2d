// SPDX-License-Identifier: Apache-2.0
// Realflare's lens models.
#include <filesystem>
#include <map>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::realflare {
namespace {

const std::string kSample = R"({
  "name": "50mm", "year": 1950, "patent_number": "US 1", "notes": "none",
  "focal_length": 88, "fstop": 4.0, "aperture_index": 2,
  "lens_elements": [
    {"radius": 50.0, "distance": 5.0, "refractive_index": 1.5168, "abbe_nr": 64.17, "height": 13.0},
    {"radius": -400.0, "distance": 2.0, "refractive_index": 1.0, "abbe_nr": 0.0, "height": 13.0},
    {"radius": 0.0, "distance": 2, "refractive_index": 1.0, "abbe_nr": 0.0, "height": 11.0},
    {"radius": 0.0, "distance": 2.0, "refractive_index": 1.6, "height": 12.0},
    {"radius": -900.0, "distance": 77.5, "refractive_index": 1, "abbe_nr": 0.0, "height": 12.0}
  ]
})";

std::string edited(std::string_view from, std::string_view to) { return replaced(kSample, from, to); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_json_lens, text, line, words);
}

}  // namespace

TEST_CASE("a Realflare model in every detail") {
  const Prescription lens = read_or_fail(read_json_lens, kSample);
  CHECK(lens.name == "50mm");
  CHECK(lens.source == "US 1");
  CHECK(lens.f_number == 4.0);
  CHECK(lens.stated.focal_length_mm == 88.0);
  CHECK(lens.stated.back_focal_distance_mm == 77.5);
  REQUIRE(lens.surfaces.size() == 5);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 50.0);
  CHECK(s[0].thickness_mm == 5.0);
  CHECK(s[0].semi_diameter_mm == 13.0);
  CHECK(s[0].source_line == 5);
  CHECK(s[0].glass_after == Glass{"", AbbeGlass{1.5168, 64.17}});
  CHECK(is_air(s[1].glass_after));
  CHECK(s[2].kind == SurfaceKind::Stop);
  CHECK(s[3].glass_after == Glass{"", ConstantIndex{1.6}});
  CHECK(s[3].curvature_per_mm == 0.0);
  CHECK(lens.warnings.empty());
  check_round_trip(lens);
}

TEST_CASE("a Realflare project with its lens in it") {
  const Prescription lens = read_or_fail(read_json_lens, "{\"flare\": {\"lens\": {\"lens_model\": " + kSample + "}}}");
  CHECK(lens.name == "50mm");
  CHECK(lens.surfaces.size() == 5);
}

TEST_CASE("Realflare's stop may be a surface of glass") {
  const Prescription lens = read_or_fail(read_json_lens, edited("\"aperture_index\": 2", "\"aperture_index\": 3"));
  REQUIRE(lens.surfaces.size() == 6);
  CHECK(is_air(lens.surfaces[2].glass_after));
  CHECK(lens.surfaces[3].kind == SurfaceKind::Stop);
  CHECK(lens.surfaces[3].thickness_mm == 0.0);
  CHECK(lens.surfaces[4].glass_after == Glass{"", ConstantIndex{1.6}});
}

TEST_CASE("Realflare's heights: semi-diameters, diameters or nonsense") {
  std::string diameters = kSample;
  for (const auto& [from, to] : {std::pair("13.0}", "26.0}"), {"13.0}", "26.0}"}, {"11.0}", "22.0}"}})
    diameters = replaced(diameters, from, to);
  const Prescription halved = read_or_fail(read_json_lens, diameters);
  CHECK(halved.surfaces[0].semi_diameter_mm == 13.0);
  REQUIRE(halved.warnings.size() == 1);
  CHECK(halved.warnings[0].find("line 4 on") != std::string::npos);
  CHECK(halved.warnings[0].find("taken for the diameter") != std::string::npos);
  std::string nonsense = replaced(kSample, "11.0}", "0.0}");
  nonsense = replaced(nonsense, "13.0}", "450.0}");
  const Prescription sized = read_or_fail(read_json_lens, nonsense);
  CHECK(sized.warnings.at(0).find("no clear aperture") != std::string::npos);
  // f/4 at 88 mm, and the contribution of the field in front of the stop.
  CHECK(sized.surfaces[0].semi_diameter_mm > 11.0);
  CHECK(sized.surfaces[0].semi_diameter_mm < 14.0);
}

TEST_CASE("what is wrong with a Realflare model, and where") {
  check_refused(edited("\"distance\": 5.0", "\"distance\": \"far\""), 5, "lens_elements[0].distance: is no number");
  check_refused(edited("\"distance\": 2.0, ", ""), 6, "lens_elements[1].distance: is missing");
  check_refused(edited("\"aperture_index\": 2", "\"aperture_index\": 7"), 3, "aperture_index: is 7; it counts the 5");
  check_refused(edited(", \"aperture_index\": 2", ""), 1, "aperture_index: is missing");
  check_refused(edited("\"name\": \"50mm\"", "\"name\": 50"), 2, "name: is no text");
  check_refused(edited("1.5168", "0.5168"), 5, "index is");
  check_refused(R"({"lens_elements": [], "aperture_index": 0})", 1, "aperture_index");
  check_refused(R"({"a": 1,
    "b": 2})",
                1, "its keys are 'a', 'b'");
  check_refused("{\n \"output\": {}, \"flare\": {\"lens\": {\n\"lens_model_path\": \"x/y.json\"}}}", 3,
                "they name the lens 'x/y.json'");
  check_refused("{\"lens\": {\"prescription_path\": \"y.json\"}, \"starburst\": {}}", 1, "they name the lens 'y.json'");
  check_refused("{\"aperture\": {\"blades\": 8}}", 1, "a preset of Realflare");
  check_refused("{\n\"a\" 1", 2, "not valid JSON");
}

TEST_CASE("Realflare's samples") {
  // Computed focal lengths; the file states 90 and 50 mm for the last two, of which one is a zoom.
  const std::map<std::string, double> kLenses = {{"Canon/ef70-200mm-f2-8l-usm.json", 72.01},
                                                 {"Kodak/100mm.json", 100.06},
                                                 {"Leica/35mm_1_4.json", 35.41},
                                                 {"Nikon/af_s_28_70mm.json", 28.47},
                                                 {"Tronnier/color-heliar.json", 100.59},
                                                 {"Nikon/ai_50_135mm.json", 35.81},
                                                 {"Zeiss/zeiss-mp-50-t1-4.json", 64.84}};
  for (const auto& [file, focal_mm] : kLenses) {
    const auto path = shared_data("lenses/realflare/model/" + file);
    if (!path) return;
    CAPTURE(file);
    const auto lens = read_lens(*path);
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    CHECK(state->focal_length_mm == test::approx(focal_mm).epsilon(1e-3));
    CHECK(lens->warnings.empty() == (file.front() != 'C'));  // of the Canon all heights are 450 or 550 mm
    check_round_trip(*lens);
  }
  const auto folder = shared_data("lenses/realflare");
  if (!folder) return;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    const std::string file = entry.path().string();
    if (entry.path().extension() != ".json" || file.find("/model/") != std::string::npos) continue;
    CAPTURE(file);
    const auto lens = read_lens(entry.path());
    REQUIRE_FALSE(lens.has_value());
    CHECK(lens.error().code == ErrorCode::Unsupported);
  }
}

}  // namespace contrejour::test::realflare
