// SPDX-License-Identifier: Apache-2.0
// DeepLens' lenses.
#include <filesystem>
#include <map>

#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::deeplens {
namespace {

const std::string kSample = R"json({
 "info": "US 1", "foclen": 88.3, "fnum": 4.4, "r_sensor": 10.0, "(sensor_size)": [1, 1],
 "surfaces": [
  {"idx": 0, "type": "Spheric", "r": 11, "(c)": 0.02, "roc": 50.0, "d": 0.0, "mat2": "1.5168/64.17", "d_next": 4.0},
  {"type": "Aspheric", "r": 11, "c": -0.0025, "k": -0.5, "ai": [0.0, 1e-6, 0.0, -2e-12], "mat2": "air", "d_next": 2.0},
  {"type": "Aperture", "r": 9.7, "mat2": "occluder", "d_next": 2.0},
  {"type": "Plane", "l": 20, "is_square": true, "mat1": "air", "mat2": "n-bk7", "d_next": 3.0},
  {"type": "Spheric", "r": 12, "roc": 0, "mat2": "air", "d_next": 79.0}
 ]
})json";

std::string edited(std::string_view from, std::string_view to) { return replaced(kSample, from, to); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_json_lens, text, line, words);
}

}  // namespace

TEST_CASE("a DeepLens lens in every detail") {
  const Prescription lens = read_or_fail(read_json_lens, kSample);
  CHECK(lens.name == "a file");
  CHECK(lens.source == "US 1");
  CHECK(lens.stated.focal_length_mm == 88.3);
  CHECK(lens.stated.back_focal_distance_mm == 79.0);
  CHECK(lens.sensor_width_mm == test::approx(14.1421).epsilon(1e-5));
  CHECK(lens.sensor_height_mm == lens.sensor_width_mm);
  REQUIRE(lens.surfaces.size() == 5);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 50.0);
  CHECK(s[0].glass_after == Glass{"", AbbeGlass{1.5168, 64.17}});
  CHECK(s[1].curvature_per_mm == -0.0025);
  CHECK(s[1].shape.conic == -0.5);
  CHECK(s[1].shape.powers == std::vector<double>{0, 0, 0, 1e-6, 0, 0, 0, -2e-12});
  CHECK(s[1].source_line == 5);
  CHECK(s[2].kind == SurfaceKind::Stop);
  CHECK(s[2].semi_diameter_mm == 9.7);
  CHECK(s[3].semi_diameter_mm == test::approx(14.1421).epsilon(1e-5));
  CHECK(s[3].aperture.kind == ApertureKind::Rectangle);
  CHECK(s[3].aperture.half_mm == Vec2{10.0, 10.0});
  CHECK(refractive_index(s[3].glass_after, kLineD_nm) == test::approx(1.5168).epsilon(1e-5));
  CHECK(s[4].curvature_per_mm == 0.0);
  CHECK(lens.f_number == test::approx(4.4).epsilon(0.05));  // that of the aperture's full opening
  CHECK(lens.warnings.empty());
  check_round_trip(lens);
}

TEST_CASE("DeepLens without an aperture, and with another f-number than its own") {
  const Prescription lens = read_or_fail(
      read_json_lens, edited("{\"type\": \"Aperture\", \"r\": 9.7, \"mat2\": \"occluder\", \"d_next\": 2.0},", ""));
  REQUIRE(lens.surfaces.size() == 5);
  CHECK(lens.surfaces[0].kind == SurfaceKind::Stop);
  CHECK(lens.surfaces[0].semi_diameter_mm == 11.0);
  CHECK(lens.warnings.at(0).find("narrowest surface (line 4)") != std::string::npos);
  const Prescription other = read_or_fail(read_json_lens, edited("\"fnum\": 4.4", "\"fnum\": 2.8"));
  CHECK(other.f_number == test::approx(4.4).epsilon(0.05));
  CHECK(other.warnings.at(0).find("fnum is 2.8 (line 2)") != std::string::npos);
}

TEST_CASE("cylinders of DeepLens") {
  const std::string sphere = "\"Spheric\", \"r\": 12, \"roc\": 0";
  const auto with = [&](const std::string& radii) {
    return edited(sphere, "\"Anamorphic\", \"r\": 12, \"cx\": -0.0075, \"cy\": 0.0, " + radii);
  };
  const Prescription lens = read_or_fail(read_json_lens, with("\"roc_x\": -133.8613, \"roc_y\": 1000000028.2819"));
  CHECK(lens.surfaces[4].curvature_per_mm == 0.0);
  CHECK(lens.surfaces[4].shape.kind == ShapeKind::Biconic);
  CHECK(lens.surfaces[4].shape.curvature_x_per_mm == 1.0 / -133.8613);
  CHECK(read_or_fail(read_json_lens, with("\"squeeze\": 1.5")).surfaces[4].shape.curvature_x_per_mm == -0.0075);
  check_round_trip(lens);
  check_refused(with("\"roc_x\": -133.8613, \"roc_y\": 400"), 8, "curved along x and along y");
}

TEST_CASE("what is wrong with a DeepLens lens, and where") {
  check_refused(edited("\"Spheric\", \"r\": 12", "\"Fresnel\", \"r\": 12"), 8,
                "surfaces[4].type: 'Fresnel' is not computed");
  check_refused(edited("n-bk7", "n-bk77777"), 7, "n-bk77777");
  check_refused(edited("\"d_next\": 4.0", "\"d_next\": null"), 4, "surfaces[0].d_next: is missing");
  check_refused(edited("-2e-12]", "\"x\"]"), 5, "surfaces[1].ai[3]: is no number");
  check_refused(edited("\"info\"", "\"DOE\": {}, \"info\""), 2, "a diffractive element");
  check_refused(edited("\"mat2\": \"occluder\", \"d_next\": 2.0", "\"d_next\": -2.0"), 6, "thickness_mm is -2");
}

TEST_CASE("DeepLens' samples") {
  // Computed focal lengths (mm) of lenses that other sources describe too: patents' 100, 35, 39, 50, 85, 16.5, 24.7,
  // ...
  const std::map<std::string, double> kFocal_mm = {
      {"ef100mm_f2.8", 100.03},  {"ef35mm_f2.0", 35.51},       {"ef40mm_f2.8", 39.0},  {"ef50mm_f1.8", 51.42},
      {"ef85mm_f1.8", 85.0},     {"rf16mm_f2.8", 16.48},       {"rf24mm_f1.8", 24.72}, {"rf50mm_f1.8", 49.56},
      {"sigma70mm_f2.8", 68.91}, {"yongnuo_50mm_f1.8", 48.96}, {"cooke", 49.88},       {"lb1471a", 49.83}};
  const auto folder = shared_data("lenses/DeepLens");
  if (!folder) return;
  int read = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    if (entry.path().extension() != ".json") continue;
    const std::string stem = entry.path().stem().string();
    CAPTURE(stem);
    const auto lens = read_lens(entry.path());
    if (!lens) {
      CHECK(lens.error().code == ErrorCode::Unsupported);
      ++refused;
      continue;
    }
    ++read;
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    if (const auto known = kFocal_mm.find(stem); known != kFocal_mm.end())
      CHECK(state->focal_length_mm == test::approx(known->second).epsilon(2e-4));
    check_round_trip(*lens);
  }
  CHECK(read == 23);
  CHECK(refused == 4);
}

}  // namespace contrejour::test::deeplens
