// SPDX-License-Identifier: Apache-2.0
// FlareSim's lenses.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::flaresim {
namespace {

const std::string kSample =
    "# A small lens\n"
    "# Patent: US001234\n"
    "# 9 surfaces, 4 glass elements, f/4.0\n"
    "\n"
    "name: Small 60mm f/4\r\n"
    "focal_length: 60.00\n"
    "\n"
    "surfaces:\n"
    "# radius       thickness    ior      abbe     semi_ap   coating\n"
    "  50.0   5.0  1.5168 64.17  11.0  1\n"
    "\t-60.0\t3.0\t1.64769\t33.85\t11.0\t1   # cemented\n"
    "  -200   2.0  1.0    0.0    11.0  0\n"
    "  0      2.0  1.0    0      8.2   0\n"
    "  STOP   2.0  1.0    0.0    8.0   0\n"
    "  inf    4.0  1.6    0.0    9.0   2\n"
    "  70.0   1.0  1.00000 0.0   9.0\n"
    "  -500   2.0  1.5    50     9.0   0   toric -400\n"
    "  -300   1.0  1.0    0      9.0   0   cyl_y\n"
    "  -900   50.0 1.0    0      9.0   0   cyl_x\n";

std::string edited(std::string_view from, std::string_view to) { return replaced(kSample, from, to); }

void check_refused(const std::string& text, int line, const std::string& words) {
  check_refused_by(read_flaresim, text, line, words);
}

}  // namespace

TEST_CASE("a FlareSim lens in every detail") {
  CHECK(looks_like_flaresim(kSample));
  CHECK_FALSE(looks_like_flaresim("[table]\nsurfaces: 1"));
  CHECK_FALSE(looks_like_flaresim("name: x\n"));
  const Prescription lens = read_or_fail(read_flaresim, kSample);
  CHECK(lens.name == "Small 60mm f/4");
  CHECK(lens.source == "US001234");
  CHECK(lens.f_number == 4.0);
  CHECK(lens.stated.focal_length_mm == 60.0);
  CHECK(lens.stated.back_focal_distance_mm == 50.0);
  REQUIRE(lens.surfaces.size() == 10);
  const auto& s = lens.surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 50.0);
  CHECK(s[0].semi_diameter_mm == 11.0);
  CHECK(s[0].glass_after == Glass{"", AbbeGlass{1.5168, 64.17}});
  CHECK(s[0].coating == Coating{"", QuarterWave{1.38, 550.0}});
  CHECK(s[1].coating == Coating{});  // cement
  CHECK(s[1].source_line == 11);
  CHECK(is_air(s[2].glass_after));
  CHECK(s[4].kind == SurfaceKind::Stop);
  CHECK(s[4].semi_diameter_mm == 8.0);
  CHECK(s[5].curvature_per_mm == 0.0);
  CHECK(s[5].glass_after == Glass{"", ConstantIndex{1.6}});
  CHECK(s[5].coating == Coating{"", DesignedCoating{CoatingDesign::Broadband, 550.0, 4}});
  CHECK(s[6].coating == Coating{});
  // A toric's own radius is that of the x-z section; a cyl_y's axis lies along y, so it curves in x.
  CHECK(s[7].curvature_per_mm == -1.0 / 400.0);
  CHECK(s[7].shape.kind == ShapeKind::Toroid);
  CHECK(s[7].shape.curvature_x_per_mm == -1.0 / 500.0);
  CHECK(s[8].curvature_per_mm == 0.0);
  CHECK(s[8].shape.curvature_x_per_mm == -1.0 / 300.0);
  CHECK(s[9].curvature_per_mm == -1.0 / 900.0);
  CHECK(s[9].shape.curvature_x_per_mm == 0.0);
  CHECK(s[9].shape.kind == ShapeKind::Toroid);
  CHECK(read_or_fail(read_flaresim, edited("  -200 ", "  1e10 ")).surfaces[2].curvature_per_mm == 0.0);
  CHECK(read_or_fail(read_flaresim, edited("60.00", "60.00 mm")).stated.focal_length_mm == 60.0);
  REQUIRE(lens.warnings.size() == 2);
  CHECK(lens.warnings[0].find("(line 11)") != std::string::npos);
  CHECK(lens.warnings[1].find("(line 15)") != std::string::npos);
  check_round_trip(lens);
}

TEST_CASE("FlareSim's heights are what the stated f-number needs") {
  // A plano-convex lens of 100 mm with its stop behind it: f/4 needs 12.5 mm less the convergence over 5 mm of glass.
  const std::string kSinglet =
      "name: A singlet\nfocal_length: 100\nsurfaces:\n"
      "50 4.5 1.5 0 {0} 0\n0 0.5 1 0 {0} 0\nstop 90 1 0 {1} 0\n";
  const auto with = [&](std::string front, std::string stop, const std::string& more) {
    std::string text = kSinglet;
    for (std::size_t at = 0; (at = text.find("{0}")) != std::string::npos;) text.replace(at, 3, front);
    return read_or_fail(read_flaresim, more + replaced(text, "{1}", stop));
  };
  const Prescription semi = with("14", "12.2", "# f/4\n");
  CHECK(semi.surfaces[2].semi_diameter_mm == 12.2);
  CHECK(semi.warnings.empty());
  const Prescription full = with("28", "24.4", "# f/4\n");
  CHECK(full.surfaces[2].semi_diameter_mm == 12.2);
  REQUIRE(full.warnings.size() == 1);
  CHECK(full.warnings[0].find("holds diameters") != std::string::npos);
  // The converter's value is used for lenses whose f-number is not known, and its files cause no warning.
  const std::string converted = "# Converted from photonstophotos.net Optical Bench data\n";
  CHECK(with("28", "24.4", converted).surfaces[2].semi_diameter_mm == 12.2);
  CHECK(with("28", "24.4", converted).warnings.empty());
  CHECK(with("14", "12.2", converted + "# f/4\n").surfaces[2].semi_diameter_mm == 12.2);
  // Without either, the heading's value is used, unless surfaces are smaller.
  CHECK(with("14", "12.2", "").surfaces[2].semi_diameter_mm == 12.2);
  CHECK(with("34", "28", "").surfaces[2].semi_diameter_mm == 14.0);
  // A value of 0 is sized for the f-number.
  CHECK(with("0", "0", "# f/4\n").surfaces[2].semi_diameter_mm == test::approx(12.2).epsilon(0.02));
}

TEST_CASE("FlareSim: an opening drawn within a lens, a lens without an image") {
  const Prescription moved = read_or_fail(read_flaresim, edited("  0      2.0  1.0", "  0     -0.5  1.0"));
  CHECK(moved.surfaces[2].thickness_mm == 1.5);
  CHECK(moved.surfaces[3].thickness_mm == 0.0);
  const Prescription lens =
      read_or_fail(read_flaresim,
                   "# f/4\nname: x\nfocal_length: 50\nsurfaces:\n-50 5 1.5 60 10 1\n60 2 1 0 10 0\nstop 40 1 0 4 0\n");
  REQUIRE(lens.sensor_distance_mm.has_value());
  CHECK(*lens.sensor_distance_mm == 40.0);
  CHECK(lens.warnings.at(0).find("form no image") != std::string::npos);
  const auto state = configure_lens(lens);
  REQUIRE(state.has_value());
  CHECK(state->sensor_z_mm == 47.0);
  // The stop has the file's size and closes in proportion: there is no marginal ray to size it by.
  CHECK(state->stop_radius_mm == 4.0);
  CHECK(configure_lens(lens, {.f_number = 8.0})->stop_radius_mm == 2.0);
}

TEST_CASE("what is wrong with a FlareSim lens, and where") {
  check_refused(edited("50.0   5.0", "5x.0   5.0"), 10, "is no surface");
  check_refused(edited("  -200   2.0  1.0    0.0    11.0  0", "  -200   2.0  1.0"), 12, "is no surface");
  check_refused(edited("11.0  0\n", "-11.0  0\n"), 12, "is no surface");
  check_refused(edited("-200   2.0", "-200   -2.0"), 12, "thickness_mm is -2");
  check_refused(edited("toric -400", "toric"), 17, "two radii");
  check_refused(edited("STOP   2.0  1.0 ", "STOP   2.0  1.5 "), 14, "the stop has another index");
  check_refused(edited("cyl_y", "conic"), 18, "surface type 'conic' is not known");
  check_refused(edited("60.00", "long"), 6, "is no focal length");
  check_refused(edited("-900   50.0 1.0 ", "-900   50.0 1.5 "), 19, "followed by air");
  check_refused("surfaces:\n", 0, "no surfaces");
  check_refused(edited("  70.0", "  stop 1 1 0 4 0\n  70.0"), 16, "a second stop");
  std::string many = "surfaces:\n";
  for (int k = 0; k < 3000; ++k) many += "50 1 1.5 60 10 0\n";
  check_refused(many, 202, "more than 200 surfaces");
}

TEST_CASE("FlareSim's samples: diameters under the heading semi_ap, focal lengths as stated") {
  int read = 0, parts = 0, focal_within_1_percent = 0, back_within_1_percent = 0, stop_fits = 0;
  for (const char* folder : {"lenses/flaresim_nuke", "lenses/blackhole-rt"}) {
    const auto path = shared_data(folder);
    if (!path) return;
    for (const auto& entry : std::filesystem::directory_iterator(*path)) {
      if (entry.path().extension() != ".lens") continue;
      const std::string file = entry.path().filename().string();
      CAPTURE(file);
      const auto lens = read_lens(entry.path());
      if (!lens) {
        CHECK_MESSAGE(lens.error().message.find("no surface is the stop, and ") != std::string::npos,
                      lens.error().to_string());
        ++parts;
        continue;
      }
      ++read;
      check_round_trip(*lens);
      const auto state = configure_lens(*lens);
      REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
      const FirstOrder figures = first_order(*state, kLineD_nm);
      const auto near = [](double a, double b) { return std::abs(a - b) <= 0.01 * std::abs(b); };
      focal_within_1_percent += near(figures.focal_length_mm, *lens->stated.focal_length_mm);
      back_within_1_percent += std::abs(figures.back_focal_distance_mm - *lens->stated.back_focal_distance_mm) <=
                               0.01 * *lens->stated.focal_length_mm;
      // The stop must not differ by a fifth from what the stated f-number requires.
      const double stop_mm = state->surfaces[static_cast<std::size_t>(state->stop_index)].semi_diameter_mm;
      stop_fits += state->stop_radius_mm > 0.8 * stop_mm && state->f_number < 1.2 * lens->f_number;
    }
  }
  CHECK(read == 244);
  CHECK(parts == 11);
  CHECK(focal_within_1_percent == 227);
  CHECK(back_within_1_percent == 234);
  CHECK(stop_fits == 244);
}

}  // namespace contrejour::test::flaresim
