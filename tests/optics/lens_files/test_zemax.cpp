// SPDX-License-Identifier: Apache-2.0
// Zemax files: a small one in every detail, every refusal, and all available samples.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/reader_checks.h"
#include "optics/lens_files/sample_lens.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::zemax {
namespace {

// A doublet, a dummy, the stop and an asphere; the image near the focus.
const std::string kZmx = R"(VERS 140124 258 36214
MODE SEQ
NAME Small lens = 4
NOTE 0 From a book,
NOTE 4
NOTE 0 page 12
UNIT MM X W X CM MR CPMM
ENPD 10
ENVD 20 1 0
GCAT SCHOTT OHARA
FTYP 0 0 2 3 0 0 0
XFLN 0 3 50
YFLN 0 4 50
WAVM 1 0.4861327 1
WAVM 2 0.55 1
PWAV 2
SURF 0
  TYPE STANDARD
  CURV 0.0 0 0 0 0 ""
  DISZ INFINITY
  DIAM 0 0 0 0 1 ""
SURF 1
  TYPE STANDARD
  CURV 0.02 0 0 0 0 ""
  DISZ 6
  GLAS N-BK7 0 0 1.5 4.0E+1 0 0 0 0 0 0
  DIAM 9 1 0 0 1 ""
SURF 2
  CURV -0.02
  DISZ 2
  GLAS ___BLANK 1 0 1.62 36.4 0.002 0 0 0 0 0
  DIAM 9 0 0 0 1 ""
SURF 3
  CURV -0.001
  DISZ 5
  DIAM 8.5
SURF 4
  CURV 0
  DISZ -2
  DIAM 7
SURF 5
  STOP
  CURV 0
  DISZ 3
  DIAM 4.9 0
SURF 6
  TYPE EVENASPH
  CURV 0.005
  CONI -1.5
  PARM 1 1e-4
  PARM 2 -2e-6
  PARM 4 3e-10
  DISZ 3
  GLAS S-BSL7
  DIAM 8
SURF 7
  CURV 0
  DISZ 75
  CLAP 0 7.5 0
SURF 8
  CURV 0
  DISZ 0
  DIAM 6
TOL TOFF 0 0
MNUM 1 1
)";

std::string zmx(const std::string& from, const std::string& to, std::string text = kZmx) {
  return edited(from, to, std::move(text));
}

Result<Prescription> read(const std::string& text) { return read_zmx({text, "a.zmx"}); }

Prescription must_read(const std::string& text) { return read_or_fail(read_zmx, text); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_zmx, text, line, words);
}

}  // namespace

TEST_CASE("a Zemax file in every detail") {
  const Prescription lens = must_read(kZmx);
  CHECK(lens.name == "Small lens = 4");
  CHECK(lens.source == "From a book, page 12");
  CHECK(lens.warnings.empty());
  REQUIRE(lens.surfaces.size() == 6);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 0.02);
  CHECK(s[0].thickness_mm == 6.0);
  CHECK(s[0].semi_diameter_mm == 9.0);
  CHECK(s[0].glass_after.name == "N-BK7");
  CHECK(refractive_index(s[0].glass_after, kLineD_nm) == test::approx(1.5168).epsilon(1e-6));
  CHECK(s[1].glass_after == Glass{"", ModelGlass{1.62, 36.4, 0.002}});
  CHECK(s[2].thickness_mm == 3.0);  // 5, and -2 of the dummy
  CHECK(is_air(s[2].glass_after));
  CHECK(s[3].kind == SurfaceKind::Stop);
  CHECK(s[3].thickness_mm == 3.0);
  CHECK(s[4].shape.conic == -1.5);
  CHECK(s[4].shape.powers == std::vector<double>{0, 1e-4, 0, -2e-6, 0, 0, 0, 3e-10});
  CHECK(s[4].glass_after.name == "S-BSL7");
  CHECK(s[5].semi_diameter_mm == 7.5);
  CHECK(s[5].source_line == 56);
  CHECK(lens.stated.wavelength_nm == 550.0);
  const auto state = configure_lens(lens);
  REQUIRE(state.has_value());
  CHECK(lens.f_number == test::approx(state->focal_length_mm / 10.0).epsilon(1e-12));
  // The stop has the size that the f-number requires, not the file's own estimate of 4.9.
  CHECK(s[3].semi_diameter_mm == state->stop_radius_mm);
  // The image surface's semi-diameter is the picture's.
  CHECK(std::hypot(lens.sensor_width_mm, lens.sensor_height_mm) == test::approx(12.0));
  REQUIRE(lens.sensor_distance_mm.has_value());
  CHECK(*lens.sensor_distance_mm == 75.0);
  CHECK(looks_like_zmx(kZmx));
  const std::string text = write_lens_toml(lens);
  const auto again = read_lens_toml(text, "b.toml");
  REQUIRE(again.has_value());
  CHECK(write_lens_toml(*again) == text);
}

TEST_CASE("Zemax' apertures, fields and units") {
  CHECK(must_read(zmx("ENPD 10", "FNUM 8 0")).f_number == 8.0);
  const Prescription by_stop = must_read(zmx("ENPD 10", "FLOA"));
  CHECK(by_stop.surfaces[3].semi_diameter_mm == 4.9);
  CHECK(by_stop.f_number == test::approx(must_read(kZmx).f_number).epsilon(0.1));
  // A stop with a size that the designer fixed is not changed.
  CHECK(must_read(zmx("DIAM 4.9 0", "DIAM 5.5 1")).surfaces[3].semi_diameter_mm == 5.5);
  // Without the image's own semi-diameter, f tan of the widest field of the two that count (3, 4 degrees).
  const Prescription by_field = must_read(zmx("  DIAM 6\n", ""));
  const double f_mm = configure_lens(by_field)->focal_length_mm;
  CHECK(std::hypot(by_field.sensor_width_mm, by_field.sensor_height_mm) ==
        test::approx(2.0 * f_mm * std::tan(5.0 * 3.14159265358979 / 180.0)));
  const Prescription by_height = must_read(zmx("FTYP 0 0 2", "FTYP 3 0 2"));
  CHECK(std::hypot(by_height.sensor_width_mm, by_height.sensor_height_mm) == test::approx(10.0));
  check_warns(must_read(zmx("FTYP 0 0 2", "FTYP 0 0 1")), "no field off the axis");
  const Prescription inches = must_read(zmx("UNIT MM", "UNIT IN"));
  CHECK(inches.surfaces[0].curvature_per_mm == 0.02 / 25.4);
  CHECK(inches.surfaces[0].thickness_mm == test::approx(6 * 25.4));
  CHECK(inches.surfaces[4].shape.powers[3] / (-2e-6 / (25.4 * 25.4 * 25.4)) == test::approx(1.0));
  CHECK(configure_lens(inches)->focal_length_mm ==
        test::approx(25.4 * configure_lens(must_read(kZmx))->focal_length_mm));
  check_warns(must_read(zmx("0.55 1", "1.55 1")), "designed for 1550 nm");
  check_warns(must_read(zmx("DISZ 75", "DISZ 30")), "distant objects are in focus at");
  check_warns(must_read(zmx("ENVD 20 1 0", "ENVD 40 1 1")), "indices at 40 deg C");
  // Rows of numbers in the form of older versions.
  CHECK(must_read(zmx("WAVM 1 0.4861327 1\nWAVM 2 0.55 1", "WAVL 0.48 0.6\nWWGT 1 1")).stated.wavelength_nm == 600.0);
  const Prescription near = must_read(zmx("DISZ INFINITY", "DISZ 5000"));
  check_warns(near, "designed for an object 5000 mm in front");
  CHECK_FALSE(near.sensor_distance_mm.has_value());
  CHECK(must_read(zmx("ENPD 10", "OBNA 0.001", zmx("DISZ INFINITY", "DISZ 5000"))).f_number ==
        test::approx(near.f_number).epsilon(0.01));
}

TEST_CASE("a stop on a surface of Zemax is a row of its own at its vertex") {
  const Prescription lens = must_read(zmx("SURF 1\n", "SURF 1\n  STOP\n", zmx("  STOP\n", "")));
  REQUIRE(lens.surfaces.size() == 6);
  CHECK(lens.surfaces[0].kind == SurfaceKind::Stop);
  CHECK(lens.surfaces[0].thickness_mm == 0.0);
  CHECK(lens.surfaces[0].semi_diameter_mm == 9.0);
  CHECK(lens.surfaces[1].semi_diameter_mm == 9.0);
  CHECK(lens.surfaces[3].thickness_mm == 6.0);  // 5, -2 and 3
}

TEST_CASE("openings of Zemax stay, rims that are no circles too") {
  const Prescription round = must_read(zmx("DISZ -2\n  DIAM 7", "DISZ 2\n  CLAP 1 6.5 0"));
  REQUIRE(round.surfaces.size() == 7);
  CHECK(round.surfaces[3].semi_diameter_mm == 6.5);
  CHECK(is_air(round.surfaces[3].glass_after));
  CHECK(round.surfaces[3].obscuration == Obscuration{{1, 1}, {}, 0.0});
  const Prescription floating = must_read(zmx("DISZ -2\n  DIAM 7", "DISZ 2\n  DIAM 7\n  FLAP 0 7 0"));
  CHECK(floating.surfaces[3].semi_diameter_mm == 7.0);
  const Prescription square = must_read(zmx("CLAP 0 7.5 0", "SQAP 3 4 0"));
  CHECK(square.surfaces[5].semi_diameter_mm == 5.0);
  CHECK(square.surfaces[5].aperture == ClearAperture{ApertureKind::Rectangle, {3, 4}, {}, 0.0});
  const Surface ellipse = must_read(zmx("CLAP 0 7.5 0", "ELAP 3 4 0\n  OBDC 0 1")).surfaces[5];
  CHECK(ellipse.semi_diameter_mm == 5.0);
  CHECK(ellipse.aperture == ClearAperture{ApertureKind::Ellipse, {3, 4}, {0, 1}, 0.0});
  CHECK(must_read(zmx("CLAP 0 7.5 0", "CLAP 0 3 0\n  OBDC 0 1")).surfaces[5].aperture ==
        ClearAperture{ApertureKind::Ellipse, {3, 3}, {0, 1}, 0.0});
  check_warns(must_read(zmx("DIAM 4.9 0", "SQAP 4 4 0")), "the stop (line 41) is not round");
  // Half a cylinder of 10 mm ends before the rectangle's corners.
  const Prescription cylinder =
      must_read(zmx("TYPE EVENASPH\n  CURV 0.005\n  CONI -1.5\n  PARM 1 1e-4\n  PARM 2 -2e-6\n  PARM 4 3e-10",
                    "TYPE TOROIDAL\n  CURV 0.1\n  SQAP 9 9"));
  CHECK(cylinder.surfaces[4].semi_diameter_mm == test::approx(10.0));
  check_warns(cylinder, "goes on where the surface ends");
  const auto last = [](const std::string& rows) { return must_read(zmx("CLAP 0 7.5 0", rows)).surfaces[5]; };
  CHECK(last("OBSC 0 1 0").obscuration == Obscuration{{1, 1}, {}, 0.0});
  CHECK(last("OBSC 0 1 0").semi_diameter_mm == last("COMM x").semi_diameter_mm);
  CHECK(last("ELOB 1 2 0\n  OBDC 0.5 0").obscuration == Obscuration{{1, 2}, {0.5, 0}, 0.0});
  CHECK(last("FLAP 1 0 0").obscuration == Obscuration{{1, 1}, {}, 0.0});
  CHECK(last("CLAP 1 4 0\n  OBDC 0 0.5").obscuration == Obscuration{{1, 1}, {0, 0.5}, 0.0});
  CHECK(last("CLAP 1 4 0\n  OBDC 0 0.5").aperture == ClearAperture{ApertureKind::Ellipse, {4, 4}, {0, 0.5}, 0.0});
  // An obscuration becomes an opening of its own, or belongs to the stop.
  const Prescription alone = must_read(zmx("DISZ -2\n  DIAM 7", "DISZ 2\n  DIAM 7\n  OBSC 0 1 0"));
  REQUIRE(alone.surfaces.size() == 7);
  CHECK(alone.surfaces[3].obscuration.any());
  const Prescription stop = must_read(zmx("DIAM 4.9 0", "CLAP 1 4.9 0"));
  CHECK(std::ranges::find(stop.surfaces, SurfaceKind::Stop, &Surface::kind)->obscuration ==
        Obscuration{{1, 1}, {}, 0.0});
  check_warns(must_read(zmx("CLAP 0 7.5 0", "OBSC 1 2 0")), "OBSC (line 59)");
  check_warns(must_read(zmx("CLAP 0 7.5 0", "SQOB 1 2 0")), "SQOB (line 59)");
  check_warns(must_read(zmx("CLAP 0 7.5 0", "COAT AR")), "AR (line 59)");
  check_warns(must_read(zmx("CLAP 0 7.5 0", "WHAT 1")), "'WHAT' of a surface is not known");
  // Behind the next vertex: it is moved there.
  const Prescription behind = must_read(zmx("CURV 0\n  DISZ 3", "CURV 0\n  DISZ -1"));
  CHECK(behind.surfaces[2].thickness_mm == 2.0);
  CHECK(behind.surfaces[3].thickness_mm == 0.0);
  check_warns(behind, "(line 41) stands behind the next surface's vertex");
}

TEST_CASE("shapes of Zemax") {
  const auto shape = [](const std::string& type) {
    return must_read(zmx("TYPE EVENASPH\n  CURV 0.005\n  CONI -1.5\n  PARM 1 1e-4\n  PARM 2 -2e-6\n  PARM 4 3e-10",
                         "TYPE " + type))
        .surfaces[4];
  };
  CHECK(shape("ODDASPHE\n CURV 0.01\n PARM 3 1e-5").shape.powers == std::vector<double>{0, 0, 1e-5});
  const Surface extended = shape("XASPHERE\n CURV 0.01\n XDAT 1 3\n XDAT 2 10\n XDAT 4 0.5\n XDAT 9 7");
  REQUIRE(extended.shape.powers.size() == 4);
  CHECK(extended.shape.powers[3] / 0.5e-4 == test::approx(1.0));
  CHECK(shape("XOSPHERE\n CURV 0.01\n XDAT 1 3\n XDAT 2 1\n XDAT 5 1e-4").shape.powers ==
        std::vector<double>{0, 0, 1e-4});
  const Surface toroid = shape("TOROIDAL\n CURV 0.01\n CONI -1\n PARM 1 50\n PARM 3 1e-6");
  CHECK(toroid.shape.kind == ShapeKind::Toroid);
  CHECK(toroid.shape.curvature_x_per_mm == 0.02);
  CHECK(toroid.shape.powers == std::vector<double>{0, 0, 0, 1e-6});
  const Surface biconic = shape("BICONICX\n CURV 0.01\n CONI -1\n PARM 1 40\n PARM 2 -2");
  CHECK(biconic.shape.kind == ShapeKind::Biconic);
  CHECK(biconic.shape.curvature_x_per_mm == 1.0 / 40.0);
  CHECK(biconic.shape.conic_x == -2.0);
}

TEST_CASE("coordinate breaks of Zemax tilt and move what stands between them") {
  // Tilted by 2 degrees about x around its first vertex and moved up by 0.5, then back.
  const std::string broken = R"(SURF 6
  TYPE COORDBRK
  PARM 2 0.5
  PARM 3 2
  DISZ 0
SURF 7
  CURV 0.005
  DISZ 3
  GLAS S-BSL7
  DIAM 8
SURF 8
  CURV 0
  DISZ 0
  CLAP 0 7.5 0
SURF 9
  TYPE COORDBRK
  DISZ -3
SURF 10
  TYPE COORDBRK
  PARM 2 -0.5
  PARM 3 -2
  PARM 6 1
  DISZ 78
SURF 11
)";
  const std::size_t from = kZmx.find("SURF 6\n"), to = kZmx.find("  CURV 0\n  DISZ 0\n  DIAM 6");
  const Prescription lens = must_read(kZmx.substr(0, from) + broken + kZmx.substr(to));
  REQUIRE(lens.surfaces.size() == 6);
  const SurfacePose &front = lens.surfaces[4].pose, &back = lens.surfaces[5].pose;
  const double tilt = 2.0 * 3.14159265358979323846 / 180.0;
  // Right-handed about x: the axis goes down, and the back vertex with it.
  CHECK(front.shift_mm == Vec3{0, 0.5, 0});
  CHECK(front.axis.y == test::approx(-std::sin(tilt)));
  CHECK(front.axis.z == test::approx(std::cos(tilt)));
  CHECK(front.axis.x == 0.0);
  CHECK(back.shift_mm.y == test::approx(0.5 - 3.0 * std::sin(tilt)));
  CHECK(back.shift_mm.z == test::approx(3.0 * std::cos(tilt) - 3.0));
  CHECK(lens.surfaces[4].thickness_mm == 3.0);
  CHECK(lens.sensor_distance_mm == 75.0);
  CHECK(lens.surfaces[3].pose == SurfacePose{});
  // Without the way back the sensor would be tilted.
  const auto askew = read(zmx("PARM 3 -2", "PARM 3 -1.5", kZmx.substr(0, from) + broken + kZmx.substr(to)));
  REQUIRE_FALSE(askew.has_value());
  CHECK(askew.error().message.find("the image surface stands") != std::string::npos);
}

TEST_CASE("a turn about the axis turns a cylinder") {
  const std::string text =
      zmx("SURF 6\n  TYPE EVENASPH\n  CURV 0.005\n  CONI -1.5\n  PARM 1 1e-4\n  PARM 2 -2e-6\n  PARM 4 3e-10",
          "SURF 6\n  TYPE COORDBRK\n  PARM 5 30\n  DISZ 0\nSURF 7\n  TYPE TOROIDAL\n  CURV 0.005");
  const Prescription lens = must_read(zmx("SURF 8\n  CURV 0\n  DISZ 0", "SURF 9\n  CURV 0\n  DISZ 0",
                                          zmx("SURF 7\n  CURV 0\n  DISZ 75", "SURF 8\n  CURV 0\n  DISZ 75", text)));
  CHECK(lens.surfaces[4].shape.rotation_rad == test::approx(30.0 * 3.14159265358979323846 / 180.0));
  CHECK(lens.surfaces[4].pose == SurfacePose{});
}

TEST_CASE("configurations of Zemax are a zoom where thicknesses alone move") {
  const std::string zoom = zmx("MNUM 1 1\n",
                               "MNUM 3 1\nMOFF 0 1 \"\" 0 0 0\n"
                               "THIC 4 1 -2 0 0 0 1 1 0 0.0 \"\"\nTHIC 4 2 6 0 0 0 1 1 0 0.0 \"\"\nTHIC 4 3 1 0\n"
                               "THIC 0 1 INFINITY 0\nTHIC 0 2 1e10 0\nTHIC 0 3 500 0\n"
                               "THIC 7 1 75 0\nTHIC 7 2 66 0\nTHIC 7 3 71 0\n");
  const Prescription lens = must_read(zoom);
  REQUIRE(lens.zoom.size() == 2);
  CHECK(lens.zoom[0].focal_length_mm < lens.zoom[1].focal_length_mm);
  // The lens decides which of the two is longer; both gaps exist.
  const double a = lens.zoom[0].thickness_mm.at(0).second, b = lens.zoom[1].thickness_mm.at(0).second;
  CHECK(std::min(a, b) == 3.0);
  CHECK(std::max(a, b) == 11.0);
  CHECK(lens.zoom[0].thickness_mm.at(0).first == 2);
  CHECK(lens.zoom[0].thickness_mm.size() == 1);
  CHECK_FALSE(lens.sensor_distance_mm.has_value());  // it moves
  check_warns(lens, "1 of 3 positions are for near objects");
  // A gap that depends on others; the glass changes too, so that the focal length does.
  for (const char* solve : {"PZUP 3 1 -2", "TCOM 3 10", "TOLE 3 8"}) {
    CAPTURE(solve);
    const Prescription solved =
        must_read(zmx("CURV 0\n  DISZ 3\n", fmt::format("CURV 0\n  DISZ 3\n  {}\n", solve),
                      zmx("MNUM 1 1\n", "MNUM 2 1\nTHIC 3 1 5 0\nTHIC 3 2 6 0\nTHIC 1 1 6 0\nTHIC 1 2 7 0\n")));
    REQUIRE(solved.zoom.size() == 2);
    REQUIRE(solved.zoom[0].thickness_mm.size() == 3);
    for (const ZoomPosition& position : solved.zoom) {
      const double third = position.thickness_mm[1].second + 2.0;  // the dummy's -2 is in it
      CHECK(position.thickness_mm[2].second == (solve[0] == 'P' ? third - 2.0 : 10.0 - third));
    }
  }
  // For anything else only the current configuration is read.
  const Prescription other =
      must_read(zmx("THIC 0 1", "CRVT 1 1 0.02 0\nCRVT 1 2 0.03 0\nCRVT 1 3 0.02 0\nTHIC 0 1", zoom));
  CHECK(other.zoom.empty());
  check_warns(other, "differ in CRVT (line 71)");
  check_warns(must_read(zmx("THIC 0 1", "APER 0 1 10 0\nAPER 0 2 11 0\nAPER 0 3 10 0\nTHIC 0 1", zoom)),
              "APER changes with the configuration");
}

TEST_CASE("glasses of Zemax") {
  const auto glass = [](const std::string& row) { return read(zmx("GLAS S-BSL7", "GLAS " + row)); };
  CHECK(glass("N-SK16 1 0 1.6207 60.28")->surfaces[4].glass_after == Glass{"N-SK16", ModelGlass{1.6207, 60.28, 0.0}});
  CHECK(refractive_index(glass("517642")->surfaces[4].glass_after, kLineD_nm) == test::approx(1.517));
  CHECK(refractive_index(glass("F_SILICA")->surfaces[4].glass_after, kLineD_nm) == test::approx(1.45846).epsilon(1e-5));
  check_warns(*glass("NOSUCH 0 0 1.61 50"), "no catalogue has the glass NOSUCH (line 54)");
  check_warns(*glass("N-BK7 0 0 1.7 50"), "has n_d 1.51680 in the catalogue, 1.70000 in the file");
  CHECK(glass("N-BK7 0 0 1.5 40")->warnings.empty());
  check_refused(zmx("GLAS S-BSL7", "GLAS NOSUCH 0 0 1.5 40"), 54, "--catalogue");
  check_refused(zmx("GLAS S-BSL7", "GLAS ___BLANK 1 0 0.5 40"), 54, "which is it?");
  check_refused(zmx("GLAS S-BSL7", "GLAS MIRROR"), 54, "a mirror");
}

TEST_CASE("what is wrong with a Zemax file, and where") {
  check_refused(zmx("DISZ INFINITY\n", "DISZ INFINITY\n  GLAS WATER\n"), 21, "the object stands in glass");
  check_refused(zmx("MODE SEQ", "MODE NSC"), 2, "non-sequential");
  check_refused(zmx("UNIT MM", "UNIT FURLONG"), 7, "'FURLONG' is not known");
  check_refused(zmx("ENPD 10", "ENPD 0"), 8, "no size of an aperture");
  check_refused(zmx("ENPD 10", "ENPD ten"), 8, "'ten' of ENPD is no number");
  check_refused(zmx("CURV 0.02", "CURV 0.0.2"), 24, "'0.0.2' of CURV is no number");
  check_refused(zmx("SURF 3", "SURF 4"), 33, "SURF 4 where SURF 3 is due");
  check_refused(zmx("TYPE EVENASPH", "TYPE DGRATING"), 46, "surface 6 is of type DGRATING");
  check_refused(zmx("TYPE EVENASPH", "TYPE TOROIDAL\n  XDAT 1 3"), 46, "Zernike");
  check_refused(zmx("TYPE EVENASPH", "TYPE XASPHERE\n  XDAT 1 20\n  XDAT 15 1"), 46, "beyond the power 20");
  check_refused(zmx("  STOP\n", ""), 59, "no surface is the stop");
  check_refused(zmx("SURF 1\n", "SURF 1\n  STOP\n"), 61, "more than one stop");
  check_refused(zmx("DISZ 6", "DISZ INFINITY"), 22, "an infinite thickness");
  check_refused(zmx("DISZ 6", "DISZ -6"), 22, "thickness_mm is -6");
  check_refused("SURF 0\nDISZ 1\nSURF 1\n", 0, "no lens");
  check_refused(zmx("MNUM 1", "MNUM 100000"), 65, "100000 configurations");
  check_refused(zmx("SURF 5\n", "SURF 5\n  TYPE COORDBRK\n  PARM 3 1\n  DISZ 0\nSURF 6\n",
                    zmx("SURF 6\n", "SURF 7\n", zmx("SURF 7\n", "SURF 8\n", zmx("SURF 8\n", "SURF 9\n")))),
                45, "the stop is decentred or tilted");
  std::string endless = "SURF 0\n";
  for (int k = 1; k < 2000; ++k) endless += "SURF " + std::to_string(k) + "\nDISZ 1\n";
  check_refused(endless, 2000, "more than 1000 surfaces");
}

TEST_CASE("Zemax' samples: read, or refused for what they hold") {
  const auto folder = shared_data("lenses");
  if (!folder) return;
  struct Outcome {
    double focal_length_mm = 0;  // 0: refused, for these words
    std::string words;
  };
  // Focal lengths from optiland's and rayoptics' own tests, and from the files' names and notes.
  const std::map<std::string, Outcome> kOutcomes = {
      {"354710-C-Zemax(ZMX).zmx", {1.4075, ""}},
      {"ACL3026U-Zemax(ZMX).zmx", {25.905, ""}},
      {"ASL5040-UV-Zemax(ZMX).zmx", {39.998, ""}},  // a Forbes asphere of 40 mm
      {"HoO-V2C18Ex03.zmx", {0, "a mirror"}},
      {"HoO-V2C18Ex27.zmx", {0, "a mirror"}},
      {"HoO-V2C18Ex46.zmx", {0, "a mirror"}},
      {"HoO-V2C18Ex66.zmx", {0, "a mirror"}},
      {"HoO-V2C18Ex66NEW.zmx", {0, "a mirror"}},
      {"US00583336-2-scaled.zmx", {49.389, ""}},  // its merit function has a target of 49.4
      {"US05331467-1.zmx", {0, "a mirror"}},
      {"US05831776-1.zmx", {0, "no image of distant objects"}},  // a relay for masks
      {"US08011793-1.zmx", {0, "a mirror"}},
      {"circular_aperture_example_with_aperture.zmx", {18.544, ""}},
      {"circular_aperture_example_without_aperture.zmx", {18.544, ""}},
      {"complicated_fold_mirrors_setup_v2.zmx", {0, "a mirror"}},
      {"curved_reflective_grating.zmx", {0, "of type DGRATING"}},
      {"curved_transmission_grating.zmx", {0, "of type DGRATING"}},
      {"flat_transmission_grating.zmx", {0, "of type DGRATING"}},
      {"lens1.zmx", {25.0, ""}},
      {"lens2.zmx", {22.5, ""}},  // "F/1.5", 15 mm
      {"lens_floa.zmx", {20.211, ""}},
      {"lens_thorlabs_iso_8859_1.zmx", {15.0, ""}},  // "f=15 mm"
      {"lenssystem.ZMX", {0, "the image surface stands"}},
      {"one_mirror_up_45deg.zmx", {0, "a mirror"}},
      {"simple_fold_mirror_up.zmx", {0, "a mirror"}},
      {"thorlabs_lj1598l1.zmx", {0, "no image of distant objects"}},  // one cylinder
      {"zemax_double_gaussian.zmx", {0, "of type PARAXIAL"}},
      {"zmax_37992.zmx", {0, "a mirror"}},
      {"zmax_55278.zmx", {52.243, ""}},
      {"zmax_84383.zmx", {0, "no image of distant objects"}},  // a negative lens
  };
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".zmx" && extension != ".ZMX") continue;
    const std::string file = entry.path().filename().string();
    CAPTURE(file);
    const auto expected = kOutcomes.find(file);
    REQUIRE(expected != kOutcomes.end());
    ++seen;
    const auto lens = read_lens(entry.path());
    const Outcome& outcome = expected->second;
    if (outcome.focal_length_mm == 0.0) {
      REQUIRE_FALSE(lens.has_value());
      CHECK(lens.error().message.find(outcome.words) != std::string::npos);
      continue;
    }
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    CHECK(state->focal_length_mm == test::approx(outcome.focal_length_mm).epsilon(1e-3));
    const std::string text = write_lens_toml(*lens);
    const auto again = read_lens_toml(text, "b.toml");
    REQUIRE_MESSAGE(again.has_value(), (again ? "" : again.error().to_string()));
    CHECK(write_lens_toml(*again) == text);
  }
  CHECK(seen == kOutcomes.size());
}

}  // namespace contrejour::test::zemax
