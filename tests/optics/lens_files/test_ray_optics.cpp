// SPDX-License-Identifier: Apache-2.0
// ray-optics' files.
#include <cmath>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::ray_optics {
namespace {

std::string object(const std::string& type, const std::string& content) {
  return fmt::format(R"({{"__instance_type__": ["module", "{}"], "attributes": {{{}}}}})", type, content);
}
std::string surface(const std::string& id, const std::string& more, const std::string& mode = "transmit") {
  return object("Surface",
                fmt::format(R"("interact_mode": "{}", "profile_id": "{}", "max_aperture": 9.5, {})", mode, id, more));
}
std::string gap(const std::string& thickness, const std::string& medium) {
  return object("Gap", fmt::format(R"("thi": {}, "medium": {})", thickness, medium));
}

const std::string kAir = object("Air", "");
const std::string kNothing = R"("decenter": null, "clear_apertures": [])";

// Surfaces are on lines 3 to 8, gaps on 10 to 14, profiles on 19 to 23.
const std::string kSample =
    "{\"optical_model\": {\"system_spec\": " + object("SystemSpec", R"("title": "A lens", "_dimensions": "MM")") +
    ",\n\"seq_model\": {\"ifcs\": [\n" + surface("0", kNothing, "dummy") + ",\n" +
    surface("1", R"("decenter": null, "clear_apertures": [)" + object("Circular", R"("radius": 9.0)") + "]") + ",\n" +
    surface("2", kNothing) + ",\n" +
    surface("3",
            R"("clear_apertures": [], "decenter": )" +
                object("DecenterData",
                       R"("dtype": "dec and return", "dec": {"__ndarray__": [0.1, -0.2, 0.0]}, "euler": [0, 0, 0])")) +
    ",\n" + surface("4", kNothing) + ",\n" + surface("0", kNothing, "dummy") + "\n],\n\"gaps\": [" + gap("1e10", kAir) +
    ",\n" +
    gap("4.0",
        object(
            "SchottGlass",
            R"("gname": "N-BK7", "coefs": {"__ndarray__": [1.03961212, 0.231792344, 1.01046945, 0.00600069867, 0.0200179144, 103.560653]})")) +
    ",\n" + gap("2.0", kAir) + ",\n" + gap("3.0", object("ModelGlass", R"("label": "517642", "n": 1.517, "v": 64.2)")) +
    ",\n" + gap("85", kAir) + "],\n\"stop_surface\": 2},\n\"optical_spec\": " +
    object("OpticalSpecs",
           "\"spectral_region\": " + object("WvlSpec", R"("wavelengths": [486.1, 546.1], "reference_wvl": 1)") +
               ",\n\"pupil\": " + object("PupilSpec", R"("value": 5.0, "_key": ["aperture", "image", "f/#"])") +
               ",\n\"field_of_view\": " +
               object("FieldSpec",
                      R"("key": ["field", "object", "angle"], "value": 10, "is_relative": true, "fields": [)" +
                          object("Field", R"("x": 0.0, "y": 1.0)") + "]")) +
    ",\n\"profile_dict\": {\"0\": " + object("Spherical", R"("cv": 0.0)") +
    ",\n\"1\": " + object("EvenPolynomial", R"("cv": 0.02, "cc": -0.5, "coefs": [0.0, 1e-6, 0.0, -1e-12])") +
    ",\n\"2\": " + object("RadialPolynomial", R"("cv": -0.003, "ec": 0.25, "coefs": [0.0, 0.0, 2e-6])") +
    ",\n\"3\": " + object("Conic", R"("cv": 0.001, "cc": -1.0)") +
    ",\n\"4\": " + object("XToroid", R"("cv": -0.002, "cR": -0.001, "cc": 0.5, "coefs": [])") + "}}}\n";

std::string edited(std::string_view from, std::string_view to) { return replaced(kSample, from, to); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_json_lens, text, line, words);
}

}  // namespace

TEST_CASE("a ray-optics file in every detail") {
  const Prescription lens = read_or_fail(read_json_lens, kSample);
  CHECK(lens.name == "A lens");
  CHECK(lens.stated.wavelength_nm == 546.1);
  CHECK(lens.f_number == 5.0);
  REQUIRE(lens.surfaces.size() == 5);  // the stop at surface 2 is a row of its own
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 0.02);
  CHECK(s[0].shape.conic == -0.5);
  CHECK(s[0].shape.powers == std::vector<double>{0, 0, 0, 1e-6, 0, 0, 0, -1e-12});
  CHECK(s[0].semi_diameter_mm == 9.0);
  CHECK(s[0].thickness_mm == 4.0);
  CHECK(s[0].source_line == 4);
  CHECK(s[0].glass_after.name == "N-BK7");
  CHECK(refractive_index(s[0].glass_after, kLineD_nm) == test::approx(1.5168).epsilon(1e-6));
  CHECK(s[1].kind == SurfaceKind::Stop);
  CHECK(s[1].thickness_mm == 0.0);
  CHECK(s[2].shape.conic == -0.75);
  CHECK(s[2].shape.powers == std::vector<double>{0, 0, 2e-6});
  CHECK(s[2].semi_diameter_mm == 9.5);
  CHECK(s[3].shape.conic == -1.0);
  CHECK(s[3].pose.shift_mm == Vec3{0.1, -0.2, 0.0});
  CHECK(s[3].glass_after == Glass{"517642", ModelGlass{1.517, 64.2}});
  CHECK(s[4].pose == SurfacePose{});
  CHECK(s[4].curvature_per_mm == -0.002);
  CHECK(s[4].shape.curvature_x_per_mm == -0.001);
  CHECK(s[4].shape.rotation_rad == test::approx(1.5707963));
  check_round_trip(lens);
}

TEST_CASE("ray-optics' apertures: the first that is none of an obscuration, turned, and the first that is one") {
  const std::string obscuration = object("Circular", R"("radius": 2.0, "is_obscuration": true)") + ", ";
  const std::string rotated =
      object("Elliptical", R"("x_half_width": 9.0, "y_half_width": 6.0, "rotation": 30, "is_obscuration": false)");
  const Prescription lens =
      read_or_fail(read_json_lens, edited(object("Circular", R"("radius": 9.0)"), obscuration + rotated));
  CHECK(lens.surfaces[0].aperture.kind == ApertureKind::Ellipse);
  CHECK(lens.surfaces[0].aperture.half_mm == Vec2{9.0, 6.0});
  CHECK(lens.surfaces[0].aperture.rotation_rad == test::approx(0.5235987756));
  CHECK(lens.surfaces[0].obscuration == Obscuration{{2, 2}, {}, 0.0});
  const std::string square =
      object("Rectangular", R"("x_half_width": 1.0, "y_half_width": 1.0, "is_obscuration": true)") + ", ";
  check_warns(read_or_fail(read_json_lens, edited(object("Circular", R"("radius": 9.0)"), square + rotated)),
              "a rectangular obscuration (line 4) is not computed");
  // An obscuration alone does not change the surface's size.
  const std::string alone = object("Circular", R"("radius": 2.0, "is_obscuration": true)");
  CHECK(read_or_fail(read_json_lens, edited(object("Circular", R"("radius": 9.0)"), alone))
            .surfaces[0]
            .semi_diameter_mm == 9.5);
}

TEST_CASE("ray-optics' older polynomials begin with the constant") {
  const Prescription lens =
      read_or_fail(read_json_lens, edited("[0.0, 0.0, 2e-6]", "[0.0, 0.0, 0.0, 2e-6, 0, 0, 0, 0, 0, 0, 0]"));
  CHECK(lens.surfaces[2].shape.powers == std::vector<double>{0, 0, 2e-6});
}

TEST_CASE("ray-optics' media: a catalogue's other glass of that name, coefficients, tables") {
  // Hoya's six coefficients are for n^2: the index differs from BSC7's own, so the file's is used.
  const auto with = [&](const std::string& medium) {
    const std::size_t begin = kSample.find("{\"__instance_type__\": [\"module\", \"SchottGlass\"]");
    const std::string_view last = "103.560653]}}}";
    const std::size_t end = kSample.find(last, begin) + last.size();
    std::string text = kSample;
    return read_or_fail(read_json_lens, text.replace(begin, end - begin, medium)).surfaces[0].glass_after;
  };
  const Glass hoya = with(object("HoyaGlass", R"("gname": "BSC7", "coefs": [2.56, 0, 0, 0, 0, 0])"));
  CHECK(refractive_index(hoya, 500.0) == test::approx(1.6).epsilon(1e-12));
  const Glass table = with(
      object("InterpolatedMedium", R"("label": "t", "wvls": [400, 500, 700, 800], "rndx": [1.53, 1.52, 1.51, 1.505])"));
  CHECK(refractive_index(table, 500.0) == test::approx(1.52).epsilon(1e-12));
  CHECK(with(object("ConstantIndex", R"("label": "c", "n": 1.6)")) == Glass{"c", ConstantIndex{1.6}});
  CHECK(with(object("Glass", R"("label": "g", "nd": 1.6, "vd": 50)")) == Glass{"g", ModelGlass{1.6, 50.0}});
}

TEST_CASE("what is wrong with a ray-optics file, and where") {
  check_refused(edited("\"4\": {\"__instance_type__\": [\"module\", \"XToroid\"]",
                       "\"4\": {\"__instance_type__\": [\"module\", \"Spline\"]"),
                23, "the profile 'Spline' is not known");
  check_refused(edited("\"interact_mode\": \"transmit\"", "\"interact_mode\": \"reflect\""), 4,
                "interact_mode: 'reflect'");
  check_refused(edited("\"Surface\"], \"attributes\": {\"interact_mode\": \"transmit\"",
                       "\"ThinLens\"], \"attributes\": {\"interact_mode\": \"transmit\""),
                4, "is a ThinLens");
  check_refused(edited("\"max_aperture\": 9.5, \"clear_apertures\"", "\"phase_element\": {}, \"clear_apertures\""), 6,
                "diffractive");
  check_refused(edited("[0, 0, 0]", "[0, 5, 0]"), 6, "tilted surfaces");
  check_refused(edited("dec and return", "bend"), 6, "decentred by 'bend'");
  check_refused(edited("\"stop_surface\": 2", "\"stop_surface\": 9"), 15, "stop_surface: is 9");
  check_refused(edited("f/#", "T"), 17, "the pupil 't' is not known");
  check_refused(edited("\"angle\"", "\"area\""), 18, "the field 'area' is not known");
  check_refused(
      edited("\"N-BK7\", \"coefs\": {\"__ndarray__\": [1.03961212, ", "\"N-BK777\", \"coefs\": {\"__ndarray__\": ["),
      11, "N-BK777");
  check_refused(edited("\"thi\": 85", "\"thi\": \"x\""), 14, "thi: is no number");
  check_refused(edited("\"MM\"", "\"furlong\""), 1, "the unit 'furlong' is not known");
  check_refused(edited("[0.0, 0.0, 2e-6]", "[0.0, 0.0, 2e-6, 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0, 1]"), 21,
                "the power 23");
}

// The efl and bfl that ray-optics itself stored in each file (parax_model), at its reference wavelength.
TEST_CASE("ray-optics' samples") {
  struct Figures {
    double focal_mm, back_mm, tolerance;
  };
  const std::map<std::string, Figures> kRead = {
      {"Sasian Triplet.roa", {50.00098928993641, 41.23764895362289, 1e-6}},
      {"Sasian Triplet old.roa", {50.00098928993641, 41.23764895362289, 1e-6}},
      {"cell_phone_camera.roa", {5.555070373138435, 0.5678391139153534, 1e-6}},
      {"cell_phone_camera_old.roa", {5.587072502725164, 0.5824047160194253, 1e-6}},
      {"f2 focuser.roa", {14.306990525622796, 11.05266006014038, 1e-6}},
      {"singlet_f3.roa", {13.334559388217107, 12.20203881846943, 1e-6}},
      {"singlet_f5.roa", {13.105460925614661, 12.660235743674322, 1e-6}},
      {"Nikon Nikkor Z 14-30mm f-4 S.roa", {14.420229234165937, 21.359437903197453, 1e-6}},
      {"US007277232_Example04P.roa", {18.499984343786203, 41.84285015594252, 1e-6}},
      {"US007277232_Example04P_hikari_glasses.roa", {19.249347121134136, 46.18098790679342, 1e-6}},
      // At 550 nm: its model glasses follow Buchdahl's formula, ours the normal line.
      {"telephoto.roa", {49.84712617462976, 24.07059249153261, 5e-4}}};
  const auto folder = shared_data("lenses/rayoptics");
  if (!folder) return;
  int read = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    if (entry.path().extension() != ".roa") continue;
    const std::string file = entry.path().filename().string();
    CAPTURE(file);
    const auto lens = read_lens(entry.path());
    const auto known = kRead.find(file);
    if (known == kRead.end()) {  // mirrors, thin lenses and a diffractive surface
      REQUIRE_FALSE(lens.has_value());
      CHECK(lens.error().code == ErrorCode::Unsupported);
      ++refused;
      continue;
    }
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    const FirstOrder figures = first_order(*state, lens->stated.wavelength_nm);
    CHECK(figures.focal_length_mm == test::approx(known->second.focal_mm).epsilon(known->second.tolerance));
    CHECK(figures.back_focal_distance_mm == test::approx(known->second.back_mm).epsilon(known->second.tolerance));
    check_round_trip(*lens);
    ++read;
  }
  CHECK(read == 11);
  CHECK(refused == 15);
}

}  // namespace contrejour::test::ray_optics
