// SPDX-License-Identifier: Apache-2.0
// CODE V's files: a small one in every detail, every refusal, and all available samples.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>

#include <nlohmann/json.hpp>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/trace.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/reader_checks.h"
#include "optics/lens_files/sample_lens.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::codev {
namespace {

// A doublet, a dummy, the stop and an asphere; the image near the focus. Mixed letter case, as people write it.
const std::string kSeq = R"(RDM;LEN       "VERSION: 10.7"
TITLE 'Small lens = 4 ; no !'
EPD   10.0
DIM   M
WL    656.3 550.0 486.1   ! C, green and F
REF   2
WTW   1 1 1
XAN   0.0 3.0
YAN   0.0 4.0
VUY   0.0 0.1; VLY 0 0.1
PRV
  PWL 656.3 587.6 &
   486.1
  'OWN' 1.61 1.62 1.63
END
SO    0.0 0.1e14
s     50.0 6.0 NBK7_SCHOTT
  CCY 0; THC 0
  CIR 9.0
Surface_label 1
S     -50.0 2.0 'OWN'
  CIR EDG 12
  CIR 9.0
S     -1000.0 5.0
  CIR 8.5
S     0.0 -2.0
S     0.0 3.0
  stop
S     200.0 3.0 620.364
  ASP
  K   -1.5; CUF 0.0
  A   -2e-6; B 0.0; C 3E-10; D 0
S     0.0 75.5
  PIM
SI    0.0 -0.5
GO
)";

std::string seq(const std::string& from, const std::string& to, std::string text = kSeq) {
  return edited(from, to, std::move(text));
}

Prescription must_read(const std::string& text) { return read_or_fail(read_seq, text); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_seq, text, line, words);
}

}  // namespace

TEST_CASE("a CODE V file in every detail") {
  const Prescription lens = must_read(kSeq);
  CHECK(lens.name == "Small lens = 4 ; no !");
  REQUIRE(lens.surfaces.size() == 6);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 0.02);
  CHECK(s[0].thickness_mm == 6.0);
  CHECK(s[0].semi_diameter_mm == 9.0);
  CHECK(s[0].glass_after.name == "NBK7_SCHOTT");
  CHECK(refractive_index(s[0].glass_after, kLineD_nm) == test::approx(1.5168).epsilon(1e-6));
  CHECK(s[1].glass_after.name == "OWN");
  CHECK(refractive_index(s[1].glass_after, 587.6) == test::approx(1.62));
  CHECK(refractive_index(s[1].glass_after, 486.1) == test::approx(1.63));
  CHECK(s[1].semi_diameter_mm == 9.0);  // not the edge
  CHECK(s[2].thickness_mm == 3.0);      // 5, and -2 of the dummy
  CHECK(s[3].kind == SurfaceKind::Stop);
  CHECK(s[4].glass_after == Glass{"620.364", ModelGlass{1.62, 36.4, 0.0}});
  CHECK(s[4].shape.conic == -1.5);
  CHECK(s[4].shape.powers == std::vector<double>{0, 0, 0, -2e-6, 0, 0, 0, 3e-10});
  CHECK(s[4].source_line == 29);
  CHECK(s[4].semi_diameter_mm > 4.0);  // for the beam
  CHECK(lens.stated.wavelength_nm == 550.0);
  CHECK(lens.f_number == test::approx(configure_lens(lens)->focal_length_mm / 10.0).epsilon(1e-12));
  CHECK(lens.sensor_distance_mm == 75.0);  // 75.5, and -0.5 of defocus
  CHECK(std::hypot(lens.sensor_width_mm, lens.sensor_height_mm) ==
        test::approx(2.0 * configure_lens(lens)->focal_length_mm * std::tan(5.0 * std::numbers::pi / 180.0)));
  REQUIRE(lens.warnings.size() == 1);
  CHECK(lens.warnings[0] == "the command Surface_label (line 20) is not known and left out");
  CHECK(looks_like_seq(kSeq));
  const std::string text = write_lens_toml(lens);
  const auto again = read_lens_toml(text, "b.toml");
  REQUIRE(again.has_value());
  CHECK(write_lens_toml(*again) == text);
}

TEST_CASE("CODE V's radii and curvatures") {
  const auto first = [](const std::string& text) { return must_read(text).surfaces[0].curvature_per_mm; };
  const std::string curvatures =
      seq("-50.0 2", "-0.02 2", seq("50.0 6", "0.02 6", seq("-1000.0 5", "-0.001 5", seq("200.0 3", "0.005 3"))));
  CHECK(first(seq("RDM;LEN", "RDM N;LEN", curvatures)) == 0.02);
  CHECK(first(seq("RDM;LEN", "LEN", curvatures)) == 0.02);
  check_warns(must_read(seq("RDM;LEN", "LEN", curvatures)), "S tells curvatures");
  // No beam of 10 mm passes a radius of 1/50 mm.
  CHECK(first(seq("RDM;LEN", "LEN")) == 0.02);
  check_warns(must_read(seq("RDM;LEN", "LEN")), "so radii are read");
  CHECK(first(seq("  CCY 0;", "  RDY 40;")) == 1.0 / 40.0);
  CHECK(first(seq("GO", "CUY S1 0.01")) == 0.01);
  CHECK(first(seq("GO", "CUY S1 UMY -0.1")) == 0.02);  // solved for: S has the result
}

TEST_CASE("CODE V's apertures, fields and units") {
  CHECK(must_read(seq("EPD   10.0", "FNO 8")).f_number == 8.0);
  CHECK(must_read(seq("EPD   10.0", "NA 0.0625")).f_number == 8.0);
  CHECK(must_read(seq("  stop\n", "  stop\n CIR 4\n", seq("EPD   10.0", ""))).surfaces[3].semi_diameter_mm == 4.0);
  const Prescription inches = must_read(seq("DIM   M", "DIM I"));
  CHECK(inches.surfaces[0].thickness_mm == test::approx(6 * 25.4));
  CHECK(inches.surfaces[4].shape.powers[3] / (-2e-6 / (25.4 * 25.4 * 25.4)) == test::approx(1.0));
  const Prescription heights = must_read(seq("XAN   0.0 3.0\nYAN   0.0 4.0", "YIM 0 7; XIM 0 0"));
  CHECK(std::hypot(heights.sensor_width_mm, heights.sensor_height_mm) == test::approx(14.0));
  const Prescription one = must_read(seq("XAN   0.0 3.0\nYAN   0.0 4.0", "YAN F2 5"));
  CHECK(one.sensor_width_mm == test::approx(must_read(kSeq).sensor_width_mm));
  check_warns(must_read(seq("REF   2", "TEM 40")), "indices at 40 deg C (line 6)");
  CHECK(must_read(seq("REF   2", "")).stated.wavelength_nm == 550.0);  // the middle one
  check_warns(must_read(seq("0.1e14", "5000")), "designed for an object 5000 mm");
  check_warns(must_read(seq("  stop\n", "")), "no surface is the stop (STO); it is S1");
}

TEST_CASE("openings of CODE V") {
  const auto last = [](const std::string& commands) { return must_read(seq("  PIM", commands)); };
  CHECK(last("CIR L'a b' 7").surfaces[5].semi_diameter_mm == 7.0);
  CHECK(last("REX 3; REY 4").surfaces[5].semi_diameter_mm == 5.0);
  CHECK(last("REX 3; REY 4").surfaces[5].aperture == ClearAperture{ApertureKind::Rectangle, {3, 4}, {}, 0.0});
  CHECK(last("REX 3; REY 4; CIR 4.5").surfaces[5].semi_diameter_mm == 4.5);
  CHECK(last("ELX 3; ELY 4; ADY 1").surfaces[5].semi_diameter_mm == 5.0);
  CHECK(last("ELX 3; ELY 4; ADY 1; ARO 30").surfaces[5].aperture ==
        ClearAperture{ApertureKind::Ellipse, {3, 4}, {0, 1}, 30.0 * std::numbers::pi / 180.0});
  CHECK(last("CIR 7; CIR OBS 1").surfaces[5].obscuration == Obscuration{{1, 1}, {}, 0.0});
  CHECK(last("CIR 7; CIR HOL L'a' 1; ADX OBS 0.5").surfaces[5].obscuration == Obscuration{{1, 1}, {0.5, 0}, 0.0});
  CHECK(last("CIR 7; ELX OBS 1; ELY OBS 2; ARO OBS 30").surfaces[5].obscuration ==
        Obscuration{{1, 2}, {}, 30.0 * std::numbers::pi / 180.0});
  CHECK(last("CIR 7; ELX OBS 1; ADX OBS 2").surfaces[5].aperture == ClearAperture{});
  CHECK(last("CIR 7; ELX OBS 1; ADX OBS 2").surfaces[5].obscuration == Obscuration{{1, 1}, {2, 0}, 0.0});
  CHECK_FALSE(last("CIR 7; ADX OBS 2").surfaces[5].obscuration.any());
  CHECK(must_read(seq("S     0.0 -2.0", "S     0.0 2.0\n CIR 6")).surfaces[3].semi_diameter_mm == 6.0);
}

TEST_CASE("cylinders and toroids of CODE V") {
  const auto shape = [](const std::string& commands) {
    return must_read(seq("  ASP\n  K   -1.5; CUF 0.0\n  A   -2e-6; B 0.0; C 3E-10; D 0", commands)).surfaces[4];
  };
  const Surface cylinder = shape("CYL");
  CHECK(cylinder.shape.kind == ShapeKind::Toroid);
  CHECK(cylinder.shape.curvature_x_per_mm == 0.0);
  CHECK(cylinder.curvature_per_mm == 1.0 / 200.0);
  const Surface toroid = shape("YTO; RDX 50; K -1; A 1e-6");
  CHECK(toroid.shape.curvature_x_per_mm == 1.0 / 50.0);
  CHECK(toroid.shape.conic == -1.0);
  CHECK(toroid.shape.powers == std::vector<double>{0, 0, 0, 1e-6});
  const Surface other = shape("XTO; CUX 0.02; K -1");
  CHECK(other.curvature_per_mm == 0.02);
  CHECK(other.shape.curvature_x_per_mm == 1.0 / 200.0);
  CHECK(other.shape.rotation_rad == test::approx(0.5 * std::numbers::pi));
  const Surface biconic = shape("AAS; CUX 0.02; KX -2; KY -1");
  CHECK(biconic.shape.kind == ShapeKind::Biconic);
  CHECK(biconic.shape.conic_x == -2.0);
  CHECK(biconic.shape.conic == -1.0);
  CHECK(shape("CON; K -3").shape.conic == -3.0);
  CHECK(shape("ASP; J 1e-20").shape.powers.size() == 20);
}

TEST_CASE("decentres of CODE V") {
  // Left-handed about x: the axis goes up.
  const double tilt = 2.0 * std::numbers::pi / 180.0;
  const Prescription alone = must_read(seq("  ASP\n", "  ASP\n  YDE 0.5; ADE 2; DAR\n"));
  CHECK(alone.surfaces[4].pose.shift_mm == Vec3{0, 0.5, 0});
  CHECK(alone.surfaces[4].pose.axis.y == test::approx(std::sin(tilt)));
  CHECK(alone.surfaces[5].pose == SurfacePose{});
  const Prescription about_y = must_read(seq("  ASP\n", "  ASP\n  BDE 2; DAR\n"));
  CHECK(about_y.surfaces[4].pose.axis.x == test::approx(-std::sin(tilt)));
  // Without DAR all further surfaces are tilted, and the sensor must not be.
  check_refused(seq("  ASP\n", "  ASP\n  YDE 0.5; ADE 2\n"), 36, "the image surface stands 3.24 mm");
  const Prescription back = must_read(seq("  PIM", "YDE -0.5", seq("  ASP\n", "  ASP\n  YDE 0.5\n")));
  CHECK(back.surfaces[4].pose.shift_mm == Vec3{0, 0.5, 0});
  CHECK(back.surfaces[5].pose == SurfacePose{});
}

TEST_CASE("glasses of CODE V") {
  const auto glass = [](const std::string& name) { return must_read(seq("620.364", name)).surfaces[4].glass_after; };
  CHECK(glass("517000.520000") == Glass{"517000.520000", ModelGlass{1.517, 52.0, 0.0}});
  CHECK(glass("500.7") == Glass{"500.7", ModelGlass{1.5, 70.0, 0.0}});
  CHECK(glass("1.5168:64.17") == Glass{"1.5168:64.17", ModelGlass{1.5168, 64.17, 0.0}});
  CHECK(glass("1.5168 64.17") == Glass{"", ModelGlass{1.5168, 64.17, 0.0}});
  CHECK(refractive_index(glass("517642"), kLineD_nm) == test::approx(1.517));
  CHECK(refractive_index(glass("N-SK16_SCHOTT"), kLineD_nm) == test::approx(1.62041).epsilon(1e-6));
  check_warns(must_read(seq("620.364", "CAF2_DAIMON-20")), "no catalogue DAIMON-20 is known (line 29)");
  const auto own = [](const std::string& row) {
    const std::string text = seq("'OWN' 1.61 1.62 1.63", row);
    return refractive_index(must_read(text).surfaces[1].glass_after, kLineD_nm);
  };
  // Schott's old formula of BK7, and Sellmeier's of N-BK7.
  CHECK(own("'OWN' LAU 2.2718929 -1.0108077e-2 1.0592509e-2 2.0816965e-4 -7.6472538e-6 4.9240991e-7") ==
        test::approx(1.5168).epsilon(1e-5));
  CHECK(own("'OWN' GMS 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653") ==
        test::approx(1.5168).epsilon(1e-5));
  check_refused(seq("'OWN' 1.61 1.62 1.63", "'OWN' 1.61 1.62"), 14, "3 wavelengths (PWL) but 2 indices");
  check_refused(seq("'OWN' 1.61 1.62 1.63", "'OWN' XYZ 1.61 1.62"), 14, "the dispersion formula XYZ");
  check_refused(seq("620.364", "NOSUCH_SCHOTT"), 29, "--catalogue");
  // One that is wrong but unused, and one that is unused.
  CHECK(must_read(seq("  'OWN'", "  'OTHER' XYZ 1.6\n  'THIRD' 1.6\n  'OWN'")).warnings.size() ==
        must_read(kSeq).warnings.size());
}

TEST_CASE("what CODE V writes that changes nothing, and what it blocks") {
  const Prescription usual = must_read(kSeq);
  const auto same = [&](const std::string& from, const std::string& to) {
    const Prescription lens = must_read(seq(from, to));
    CAPTURE(to);
    CHECK(lens.warnings == usual.warnings);
    REQUIRE(lens.surfaces.size() == usual.surfaces.size());
    CHECK(write_lens_toml(lens) == write_lens_toml(usual));
  };
  same("WTW   1 1 1", "DOR   1.15 1.05 1.1; PRE 760.0; PUX 1.0; PUY 1.0");
  same("GO", "UID   S0 \"6c7b\"; CMP DLZ S1; DSX 1; BTX 2\nGO");
  // A decentre of 0 is accepted, whatever its kind.
  same("  ASP\n", "  ASP\n  XDE 0.0; YDE 0.0; ZDE 0.0; BEN\n  ADE 0.0; BDE 0.0; CDE 0.0; REV\n");
  same("TITLE '", "TITLE '\"");
  check_warns(must_read(seq("PRV", "PRE 700\nPRV")), "the pressure of the air (line 11)");
  check_warns(must_read(seq("  ASP\n", "  ASP\n  REX OBS 2; REY OBS 3\n")), "REX OBS (line 31) is not computed");
  // A sum of other gaps does not make this one a zoom gap.
  const std::string zoom = "ZOO 2; ZOO THI S4 -2 -3; ZOO THI S1 6 7\n";
  CHECK(write_lens_toml(must_read(seq("GO", zoom + "THI S5 OAL S4..8 1"))) ==
        write_lens_toml(must_read(seq("GO", zoom))));
}

TEST_CASE("positions of CODE V are a zoom where thicknesses alone move") {
  const std::string zoom =
      seq("GO",
          "ZOO 3\nZOO TIT\nTIT Z1 'a'\nZOO THI S4 -2 6 1\nZOO THI S0 1e13 1e13 500\nZOO THC S4 100 100 100\n"
          "ZOO THI S7 75.5 66 71\nGO");
  const Prescription lens = must_read(zoom);
  REQUIRE(lens.zoom.size() == 2);
  const double a = lens.zoom[0].thickness_mm.at(0).second, b = lens.zoom[1].thickness_mm.at(0).second;
  CHECK(std::min(a, b) == 3.0);
  CHECK(std::max(a, b) == 11.0);
  CHECK_FALSE(lens.sensor_distance_mm.has_value());
  check_warns(lens, "1 of 3 positions are for near objects");
  // Gaps set one by one, and a gap that compensates for another.
  const Prescription solved =
      must_read(seq("GO", "ZOO 2; ZOO THI S4; THI S4 Z1 -2; THI S4 Z2 -3; ZOO THI S1 6 7\nTHI S5 OAL S4..6 1"));
  REQUIRE(solved.zoom.size() == 2);
  for (const ZoomPosition& position : solved.zoom)
    CHECK(position.thickness_mm.at(1).second + position.thickness_mm.at(2).second == 6.0);
  const Prescription picked =
      must_read(seq("GO", "ZOO 2; ZOO THI S4 -2 -3; ZOO THI S1 6 7\nPIK THI S5 Z1 THI S4 Z1 -1.0"));
  for (const ZoomPosition& position : picked.zoom)
    CHECK(position.thickness_mm.at(1).second + position.thickness_mm.at(2).second == 5.0);
  const Prescription other = must_read(seq("ZOO THI S4", "ZOO RDY S1 50 60 50\nZOO THI S4", zoom));
  CHECK(other.zoom.empty());
  check_warns(other, "differ in RDY");
  check_warns(must_read(seq("ZOO THI S4", "ZOO EPD 10 11 10\nZOO THI S4", zoom)), "EPD changes with the position");
}

TEST_CASE("what is wrong with a CODE V file, and where") {
  check_refused(seq("EPD   10.0", "EPD ten"), 3, "'ten' of EPD is no number");
  check_refused(seq("EPD   10.0", "EPD 0"), 3, "no size of an aperture");
  check_refused(seq("DIM   M", "DIM F"), 4, "the unit 'F' is not known");
  check_refused(seq("50.0 6.0", "x50.0 6.0"), 17, "'x50.0' is no radius");
  check_refused(seq("50.0 6.0", "50.0 x6.0"), 17, "'x6.0' is no thickness");
  check_refused(seq("200.0 3.0 620.364", "200.0 3.0 REFL"), 29, "a mirror (REFL)");
  check_refused(seq("  PIM", "  RMD REFL"), 34, "a mirror (RMD REFL)");
  check_refused(seq("  ASP\n", "  ASP\n BEN; ADE 5\n"), 31, "a bend of the axis (BEN)");
  check_refused(seq("  ASP\n", "  ASP\n YDE 1; REV\n"), 31, "a reversed decentre (REV)");
  check_refused(seq("  ASP\n", "  GRT 1\n"), 30, "a grating");
  check_refused(seq("  ASP\n", "  SPS QBF\n"), 30, "a special surface");
  check_refused(seq("CUF 0.0", "CUF 0.1"), 29, "a Fresnel surface");
  check_refused(seq("A   -2e-6", "A  abc"), 32, "'abc' is no number");
  check_refused(seq("  PIM", "CIR S20 5"), 34, "CIR of a surface that is not there");
  check_refused(seq("SI    0.0", "S20   0.0"), 35, "S20 where S8 is due");
  check_refused(seq("END\n", "\n"), 16, "do not END");
  check_refused(seq("GO", "GLA S1..3 NBK7_SCHOTT"), 36, "name one surface");
  check_refused(seq("GO", "SCA 2"), 36, "an edit of the lens");
  check_refused(seq("0.1e14", "0.1e14 NBK7_SCHOTT"), 16, "the object stands in glass");
  check_refused(seq("GO", "ZOO 1000"), 36, "1 to 200 positions");
  check_refused(seq("GO", "ZOO THI S4 a b"), 36, "give the surface and its thickness");
  check_refused("RDM\nSO 0 1e13\nSI 0 0\n", 0, "no lens");
  check_refused(seq("EPD   10.0", ""), 0, "the lens's aperture is not told");
  check_refused(seq("6.0 NBK7", "1e20 NBK7"), 17, "an infinite thickness");
  std::string commands = kSeq;
  for (int k = 0; k < 50'000; ++k) commands += ";GO";
  check_refused(commands, 0, "more than 49999 commands");
  std::string endless = "RDM\nSO 0 1e13\n";
  for (int k = 1; k < 2000; ++k) endless += "S 0 1\n";
  check_refused(endless, 1002, "more than 1000 surfaces");
}

TEST_CASE("CODE V's samples: read, or refused for what they hold") {
  const auto folder = shared_data("lenses");
  if (!folder) return;
  struct Outcome {
    double focal_length_mm = 0;  // 0: refused, for these words
    std::string words;
  };
  const Outcome mirror{0, "a mirror"};
  const std::map<std::string, Outcome> kOutcomes = {
      {"CODV_32327.seq", {100.03, ""}},  // rayoptics' output for it: 100
      {"CODV_35571.seq", mirror},
      {"CODV_49664.seq", {35.01, ""}},  // 35 by its title
      {"CODV_65564.seq", {1.499, ""}},
      {"CODV_65988.seq", {0, "a diffractive surface"}},
      {"CODV_65988_noDOE.seq", {15.856, ""}},
      {"achroMangin.seq", mirror},
      {"achroMangin_ok.seq", mirror},
      {"ag_dblgauss.seq", {100.0037, ""}},  // optiland's DoubleGauss
      {"asp46.seq", {0, "no image of distant objects"}},
      {"dar_test.seq", {0, "no surface refracts"}},
      {"dec_rev_tilt_test.seq", {0, "a reversed decentre"}},
      {"dec_test.seq", {0, "a mirror"}},
      {"dec_tilt_test.seq", mirror},
      {"folded_lenses.seq", mirror},
      {"landscape_lens.seq", {10.0, ""}},
      {"lens_reflection_test.seq", mirror},
      {"mangin.seq", mirror},
      {"paraboloid.seq", mirror},
      {"paraboloid_f8.seq", mirror},
      {"questar35.seq", mirror},
      {"rc_f16.seq", mirror},
      {"schmidt.seq", mirror},
      {"schmidt_sph.seq", mirror},
      {"singlet.seq", {13.005, ""}},
      {"test.seq", {159.52, ""}},
      {"threemir.seq", mirror},
      {"tilt_test.seq", {0, "a reversed decentre"}},
      {"unfolded_lenses_w_ape.seq", {0, "f_number is 2564"}},  // nearly afocal
      {"asphere.seq", {60.328, ""}},
      {"cooke_triplet.seq", {50.334, ""}},
      {"fno_fields.seq", {98.102, ""}},
      {"mirror.seq", mirror},
      {"telescope_objective.seq", {47.994, ""}},
  };
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    if (entry.path().extension() != ".seq") continue;
    const std::string file = entry.path().filename().string();
    CAPTURE(file);
    const auto expected = kOutcomes.find(file);
    REQUIRE(expected != kOutcomes.end());
    ++seen;
    const auto lens = read_lens(entry.path());
    const Outcome& outcome = expected->second;
    if (outcome.focal_length_mm == 0.0) {
      REQUIRE_FALSE(lens.has_value());
      CAPTURE(lens.error().to_string());
      CHECK(lens.error().message.find(outcome.words) != std::string::npos);
      continue;
    }
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    CHECK(state->focal_length_mm == test::approx(outcome.focal_length_mm).epsilon(1e-4));
    const std::string text = write_lens_toml(*lens);
    const auto again = read_lens_toml(text, "b.toml");
    REQUIRE_MESSAGE(again.has_value(), (again ? "" : again.error().to_string()));
    CHECK(write_lens_toml(*again) == text);
  }
  CHECK(seen == kOutcomes.size());
}

TEST_CASE("the double Gauss's marginal ray is rayoptics', surface by surface") {
  const auto file = shared_data("lenses/rayoptics/codev/tests/ag_dblgauss.seq");
  const auto oracle = shared_data("oracles/rayoptics_double_gauss_marginal_ray.json");
  if (!file || !oracle) return;
  std::ifstream stream(*oracle);
  const nlohmann::json expected = nlohmann::json::parse(stream).at("expected_marginal_ray");
  const auto lens = read_lens(*file);
  REQUIRE(lens.has_value());
  const LensState state = *configure_lens(*lens);
  const OpticalPath path = direct_path(state, 587.6);
  const RayRecord record = trace_recorded(path, {{25.0, 0.0, -10.0}, {0.0, 0.0, 1.0}});
  REQUIRE(record.steps.size() == 11);
  REQUIRE(expected.size() == 13);
  constexpr double kPrinted = 1e-6;  // six decimals, and indices that two programs round
  for (std::size_t k = 0; k < record.steps.size(); ++k) {
    CAPTURE(k);
    const TraceStep& step = record.steps[k];
    const auto& row = expected.at(k + 1);
    const double z_mm = step.position_mm.z - state.surfaces[k].z_mm;
    CHECK(std::abs(step.position_mm.x - row.at(0).at(0).get<double>()) < kPrinted);
    CHECK(std::abs(z_mm - row.at(0).at(2).get<double>()) < kPrinted);
    CHECK(std::abs(step.direction_after.x / step.direction_after.z - row.at(1).at(0).get<double>()) < kPrinted);
  }
  CHECK(std::abs(record.ray.sensor_mm.x - expected.at(12).at(0).at(0).get<double>()) < kPrinted);
}

}  // namespace contrejour::test::codev
