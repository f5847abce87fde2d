// SPDX-License-Identifier: Apache-2.0
// Less common parts of Zemax files: glasses with other rows, tilts, types with nothing beyond the usual, old numbers.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/reader_checks.h"
#include "support/approx.h"

namespace contrejour::test::zemax_variants {
namespace {

// Two lenses with the stop between.
const std::string kPair = R"(MODE SEQ
ENPD 10
FTYP 0 0 2 1 0 0 0
XFLN 0 0
YFLN 0 5
WAVM 1 0.5875618 1
SURF 0
  DISZ INFINITY
SURF 1
  TYPE STANDARD
  CURV 0.01
  DISZ 4
  GLAS N-BK7 0 0 1.5 40 0 0 0 0 0 0
  DIAM 8 1
SURF 2
  CURV 0
  DISZ 3
  DIAM 8 1
SURF 3
  STOP
  DISZ 3
  DIAM 5
SURF 4
  TYPE STANDARD
  CURV 0.01
  DISZ 4
  GLAS N-SF2 0 0 1.5 40 0 0 0 0 0 0
  DIAM 8 1
SURF 5
  CURV -0.005
  DISZ 60
  DIAM 8 1
SURF 6
  DISZ 0
)";

std::string pair(std::string_view from, std::string_view to) { return replaced(kPair, from, to); }
Prescription must_read(const std::string& text) { return read_or_fail(read_zmx, text); }
void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_zmx, text, line, words);
}
const std::string kSecondGlass = "GLAS N-SF2 0 0 1.5 40 0 0 0 0 0 0";

}  // namespace

TEST_CASE("a Zemax glass is picked up from another surface") {
  const Prescription lens = must_read(pair(kSecondGlass, "GLAS ___BLANK 2 1 1.5 40 0 0 0 0 0 0"));
  CHECK(lens.surfaces[3].glass_after == lens.surfaces[0].glass_after);
  CHECK(lens.surfaces[3].glass_after.name == "N-BK7");
  check_refused(pair(kSecondGlass, "GLAS ___BLANK 2 5 1.5 40"), 27, "a glass picked up from surface 5");
  // With its name it is the named glass.
  CHECK(must_read(pair("GLAS N-SF2 0 0", "GLAS N-SF2 2 1")).surfaces[3].glass_after.name == "N-SF2");
}

TEST_CASE("a Zemax glass is offset from its catalogue's") {
  const Glass plain = must_read(kPair).surfaces[3].glass_after;
  const Prescription lens = must_read(pair(kSecondGlass, "GLAS N-SF2 4 0 1.5 40 0 0 0 0 0.002 -0.5"));
  CHECK(lens.warnings.size() == must_read(kPair).warnings.size());
  const Glass& glass = lens.surfaces[3].glass_after;
  const GlassFigures before = glass_figures(plain), after = glass_figures(glass);
  CHECK(after.n_d == test::approx(before.n_d + 0.002).epsilon(1e-7));
  CHECK(after.v_d == test::approx(before.v_d - 0.5).epsilon(1e-4));
  CHECK(after.p_gf == test::approx(before.p_gf).epsilon(1e-4));
  CHECK(glass.name == "N-SF2 offset");
  check_round_trip(lens);
  // An offset of zero: the glass itself.
  CHECK(must_read(pair(kSecondGlass, "GLAS N-SF2 4 0 1.5 40 0 0 0 0 0 0")).surfaces[3].glass_after == plain);
  check_refused(pair(kSecondGlass, "GLAS N-SF2 4 0 1.5 40 0 0 0 0 -3 0"), 27, "N-SF2 with n_d moved by -3");
}

TEST_CASE("a tilt of a Zemax surface's own is refused, not left out") {
  const std::string shown = "  CURV 0.01\n  SCBD 1 0 0 0 0 0 0 0\n";
  const std::string tilted = "  CURV 0.01\n  SCBD 1 0 0 0 0 9.0E+01 0 0\n";
  CHECK(must_read(pair("  CURV 0.01\n", shown)).warnings.size() == must_read(kPair).warnings.size());
  check_refused(pair("  CURV 0.01\n", tilted), 12, "SCBD");
}

TEST_CASE("Zemax rows that are not set in are of their surface all the same") {
  std::string flat = kPair;
  for (std::size_t at = flat.find("\n  "); at != std::string::npos; at = flat.find("\n  ")) flat.replace(at, 3, "\n");
  flat = replaced(flat, "CURV 0.01\n", "FIMP\nHIDE 0 0\nCURV 0.01\n");
  const Prescription lens = must_read(flat), usual = must_read(kPair);
  REQUIRE(lens.surfaces.size() == usual.surfaces.size());
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    CHECK(lens.surfaces[k].curvature_per_mm == usual.surfaces[k].curvature_per_mm);
    CHECK(lens.surfaces[k].thickness_mm == usual.surfaces[k].thickness_mm);
    CHECK(lens.surfaces[k].glass_after == usual.surfaces[k].glass_after);
  }
  CHECK(lens.warnings.size() == usual.warnings.size());
}

TEST_CASE("a tilted plane of Zemax") {
  const auto tilted = [](const std::string& tangents) {
    return pair("SURF 2\n  CURV 0\n", "SURF 2\n  TYPE TILTSURF\n  CURV 0\n" + tangents);
  };
  const Prescription lens = must_read(tilted("  PARM 1 0.02\n  PARM 2 -0.01\n"));
  const Vec3 normal = lens.surfaces[1].pose.axis;
  CHECK(-normal.x / normal.z == test::approx(0.02).epsilon(1e-12));
  CHECK(-normal.y / normal.z == test::approx(-0.01).epsilon(1e-12));
  // Only this surface is tilted: those behind it are unchanged.
  CHECK(lens.surfaces[3].pose == SurfacePose{});
  CHECK(must_read(tilted("")).surfaces[1].pose == SurfacePose{});
  check_refused(pair("SURF 6\n", "SURF 6\n  TYPE TILTSURF\n  PARM 2 0.1\n"), 33, "the image surface stands");
  check_refused(tilted("  PARM 1 INFINITY\n"), 15, "a tilt's tangent is infinite");
}

TEST_CASE("Zemax types with terms that are not computed are read where all are 0") {
  const auto of_type = [](const std::string& type, const std::string& rows) {
    return pair("  TYPE STANDARD\n  CURV 0.01\n", "  TYPE " + type + "\n  CURV 0.01\n" + rows);
  };
  const std::string none = "  XDAT 1 2 0 0\n  XDAT 2 10 0 0\n  XDAT 3 0 0 0\n  XDAT 4 0 0 0\n";
  const std::string some = "  XDAT 1 2 0 0\n  XDAT 2 10 0 0\n  XDAT 4 -120 0 0\n";
  for (const char* type : {"BINARY_1", "BINARY_2", "FZERNSAG", "SZERNSAG", "XPOLYNOM"}) {
    CAPTURE(type);
    CHECK(must_read(of_type(type, none)).surfaces[0].curvature_per_mm == 0.01);
    check_refused(of_type(type, some), 9, type);
  }
  CHECK(must_read(of_type("BINARY_2", "  PARM 2 1e-6\n" + none)).surfaces[0].shape.powers ==
        std::vector<double>{0, 0, 0, 1e-6});
  check_refused(of_type("BINARY_2", some), 9, "its phase are not computed");
  CHECK(must_read(of_type("IRREGULA", "  PARM 1 0\n")).surfaces[0].shape.is_sphere());
  check_refused(of_type("IRREGULA", "  PARM 5 1e-3\n"), 9, "its irregularity");
}

TEST_CASE("coefficients beyond the eight of Zemax's own aspheres") {
  const auto of_type = [](const std::string& type, const std::string& rows) {
    return pair("  TYPE STANDARD\n  CURV 0.01\n", "  TYPE " + type + "\n  CURV 0.01\n" + rows);
  };
  std::vector<double> powers(20);
  powers[19] = 1e-24;
  CHECK(must_read(of_type("EVENASPH", "  PARM 9 0\n  PARM 10 1e-24\n")).surfaces[0].shape.powers == powers);
  powers = std::vector<double>(9);
  powers[8] = 1e-12;
  CHECK(must_read(of_type("ODDASPHE", "  PARM 9 1e-12\n")).surfaces[0].shape.powers == powers);
  CHECK(must_read(of_type("EVENASPH", "  PARM 11 0\n")).surfaces[0].shape.powers.empty());
  check_refused(of_type("EVENASPH", "  PARM 11 1e-30\n"), 9, "goes beyond the power 20");
}

TEST_CASE("apertures of Zemax as old and odd as they come") {
  // The half angle of a cone at the object.
  const std::string near = pair("  DISZ INFINITY", "  DISZ 300");
  const Prescription by_na = must_read(replaced(near, "ENPD 10", "OBNA 0.02 0"));
  const Prescription by_cone = must_read(replaced(near, "ENPD 10", "OBNA 1.1459919983 1"));
  CHECK(by_cone.f_number == test::approx(by_na.f_number).epsilon(1e-9));
  // A semi-diameter from a ray that failed is treated as missing.
  for (const char* infinite : {"1.#INF000000000E+000", "INFINITY", "-1.#INF"}) {
    const Prescription lens = must_read(pair("  DIAM 8 1\nSURF 2", std::string("  DIAM ") + infinite + " 0\nSURF 2"));
    CHECK(lens.surfaces[0].semi_diameter_mm > 5.0);
    CHECK(lens.surfaces[0].semi_diameter_mm < 7.0);
  }
}

TEST_CASE("a stop that nothing tells the size of lets through what the other surfaces do") {
  const Prescription lens = must_read(replaced(pair("ENPD 10", "FLOA"), "  DIAM 5\n", ""));
  check_warns(lens, "nothing tells the stop's size");
  // The front is as wide as the beam; behind it the beam is narrower, and the rims have the same size.
  CHECK(lens.surfaces[2].kind == SurfaceKind::Stop);
  const auto state = configure_lens(lens);
  REQUIRE(state.has_value());
  CHECK(lens.f_number == test::approx(state->focal_length_mm / 16.0).epsilon(0.01));
  CHECK(lens.surfaces[2].semi_diameter_mm < 8.0);
  std::string bare = replaced(pair("ENPD 10", "FLOA"), "  DIAM 5\n", "");
  for (int k = 0; k < 4; ++k) bare = replaced(bare, "  DIAM 8 1\n", "");
  check_refused(bare, 0, "the lens's aperture is not told");
}

TEST_CASE("a curved image surface is a warning") {
  check_warns(must_read(pair("SURF 6\n", "SURF 6\n  CURV -0.01\n")), "the image surface (line 33) is curved");
}

}  // namespace contrejour::test::zemax_variants
