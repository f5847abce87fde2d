// SPDX-License-Identifier: Apache-2.0
// Optical Bench's files: a small one in every detail, errors, and all available samples.
#include <doctest/doctest.h>

#include <filesystem>
#include <set>
#include <string>

#include "base/decode_text.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::optical_bench {
namespace {

// A triplet that zooms slightly, with an asphere and a separate opening.
const std::string kSample =
    "[descriptive data]\t\n"
    "title\tUS 1,234 Example 5 (Small Zoom 50-60mm f/4)\n"
    "[constants]\n"
    "[variable distances]\r\n"
    "Focal Length\t50.5\t60.25\tundefined\n"
    "F-Number\t4\t4.5\tundefined\n"
    "Image Height\t43.2666\t43.2666\t43.2666\n"
    "Magnification\t0\t0\t-0.1\n"
    "d0\tInfinity\tInfinity\t500\n"
    "d4\t9.5\t6.25\t7\n"
    "Bf\t40\t41\t45\n"
    "[lens data]\n"
    "1\t26.5\t3\t1.62041\t20\t60.3\n"
    "2\tInfinity\t4\t\t20\t\n"
    "3\t-60\t1\t1.6\t16\n"
    "4\t25\td4\t\t14\n"
    "5\tAS\t2\t\t8\n"
    "6\tFS\t-0.5\t\t9\n"
    "7\t80\t3\t1.5168\t16\t64.1\n"
    "8\t-20\tBf\t\t16\n"
    "[aspherical data]\n"
    "8\t-20\t-0.5\t1.5E-06\t\n"
    "[figure]\n"
    "source\tx.png\n";

std::string edited(std::string_view from, std::string_view to) {
  std::string text = kSample;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

void check_refused(const std::string& text, int line, const std::string& words) {
  const auto lens = read_optical_bench({decode_text(text), "a.txt"});
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().to_string());
  CHECK(lens.error().message.find(words) != std::string::npos);
  CHECK(lens.error().position.line == line);
}

}  // namespace

TEST_CASE("an Optical Bench file in every detail") {
  const auto lens = read_optical_bench({decode_text(kSample), "a.txt"});
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  CHECK(lens->name == "Small Zoom 50-60mm f/4");
  CHECK(lens->source == "US 1,234 Example 5");
  CHECK(lens->f_number == 4.0);
  CHECK(lens->sensor_width_mm == test::approx(36.0).epsilon(1e-5));
  CHECK(lens->sensor_height_mm == test::approx(24.0).epsilon(1e-5));
  REQUIRE(lens->surfaces.size() == 8);
  const auto& s = lens->surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 26.5);
  CHECK(s[0].thickness_mm == 3.0);
  CHECK(s[0].semi_diameter_mm == 10.0);
  CHECK(s[0].glass_after == Glass{"", AbbeGlass{1.62041, 60.3}});
  CHECK(s[1].curvature_per_mm == 0.0);
  CHECK(is_air(s[1].glass_after));
  CHECK(s[2].glass_after == Glass{"", ConstantIndex{1.6}});
  CHECK(s[4].kind == SurfaceKind::Stop);
  CHECK(s[4].semi_diameter_mm == 4.0);
  CHECK(s[4].thickness_mm == 1.5);  // the opening behind it has moved to the next lens's vertex
  CHECK(s[5].thickness_mm == 0.0);
  CHECK(s[5].semi_diameter_mm == 4.5);
  CHECK(s[7].shape.conic == -0.5);
  CHECK(s[7].shape.powers == std::vector<double>{0.0, 0.0, 0.0, 1.5e-6});
  CHECK(s[7].source_line == 20);
  REQUIRE(lens->zoom.size() == 2);
  CHECK(lens->zoom[0].focal_length_mm == 50.5);
  CHECK(lens->zoom[1].thickness_mm == std::vector<std::pair<int, double>>{{3, 6.25}});
  CHECK(lens->stated.focal_length_mm == 50.5);
  CHECK(lens->stated.back_focal_distance_mm == 40.0);
  CHECK(looks_like_optical_bench(kSample));
}

TEST_CASE("Optical Bench's comments, planes on either side, names") {
  std::string text = edited("2\tInfinity", "#2\tno radius\n2\t-Infinity");
  text = replaced(text, "title\tUS 1,234 Example 5 (Small Zoom 50-60mm f/4)", "lens name\tSmall zoom");
  const Prescription lens = read_or_fail(read_optical_bench, text);
  CHECK(lens.name == "Small zoom");
  CHECK(lens.surfaces[1].curvature_per_mm == 0.0);
  CHECK(lens.surfaces.size() == 8);
}

TEST_CASE("Optical Bench's aspheres with r^2 or odd powers, as its constants say") {
  const auto powers = [](const std::string& constant, const std::string& coefficients) {
    std::string text = edited("[lens data]", "[constants]\n" + constant + "\n[lens data]");
    text = replaced(text, "1.5E-06\t", coefficients);
    return read_or_fail(read_optical_bench, text).surfaces[7].shape.powers;
  };
  CHECK(powers("Scaled\t50\t100", "1e-6\t2e-8") == std::vector<double>{0, 0, 0, 1e-6, 0, 2e-8});
  CHECK(powers("AsphericalA2", "1e-5\t1e-6\t2e-8") == std::vector<double>{0, 1e-5, 0, 1e-6, 0, 2e-8});
  CHECK(powers("AsphericalOddCount\t1", "3e-6\t4e-7\t6e-9\t8e-11") ==
        std::vector<double>{0, 0, 3e-6, 4e-7, 0, 6e-9, 0, 8e-11});
  CHECK(powers("AsphericalOddCount\t2", "3e-6\t4e-7\t5e-8\t6e-9\t8e-11") ==
        std::vector<double>{0, 0, 3e-6, 4e-7, 5e-8, 6e-9, 0, 8e-11});
  CHECK(powers("AsphericalOddCount\t0", "4e-7\t6e-9") == std::vector<double>{0, 0, 0, 4e-7, 0, 6e-9});
  for (const char* count : {"", "-1", "1.5", "one"})
    check_refused(edited("[lens data]", std::string("[constants]\nAsphericalOddCount\t") + count + "\n[lens data]"), 13,
                  "is no count of odd coefficients");
}

TEST_CASE("what is wrong with an Optical Bench file, and where") {
  check_refused(edited("26.5", "x26"), 13, "is no radius");
  check_refused(edited("26.5", "0"), 13, "is no radius");
  check_refused(edited("\t1.62041\t20\t60.3", "\t1.62041\tbig\t60.3"), 13, "diameter");
  check_refused(edited("1.62041", "1.62x"), 13, "are no n_d and V_d");
  check_refused(edited("60.3\n", "sixty\n"), 13, "are no n_d and V_d");
  check_refused(edited("25\td4", "25\td9"), 16, "the gap 'd9'");
  check_refused(edited("8\t-20\t-0.5", "9\t-20\t-0.5"), 22, "no surface is called '9'");
  check_refused(edited("8\t-20\t-0.5", "8\t-21\t-0.5"), 22, "which is right?");
  check_refused(edited("1.5E-06", "1.5E"), 22, "is no coefficient");
  check_refused(edited("Focal Length\t50.5\t60.25", "Focal Length\tundefined\tundefined"), 5,
                "focal length for distant");
  check_refused(edited("F-Number\t4\t4.5", "F-Number\t\t"), 0, "no F-Number");
  check_refused("[lens data]\n", 0, "no column");
  check_warns(read_or_fail(read_optical_bench, edited("5\tAS", "5\tFS")), "no surface is the stop; the opening");
  check_refused(edited("-0.5\t\t9", "-9.5\t\t9"), 17, "thickness_mm");
  std::string endless = kSample + "[notes]\n";
  for (int k = 0; k < 3000; ++k) endless += "a\n";
  check_refused(endless, 2008, "more than 2000 lines");
}

TEST_CASE("Optical Bench's samples: read, and as their figures say") {
  // Diameters are measured from drawings; in these lenses two surfaces would cross near their rims.
  const std::set<std::string> kCrossing = {"JP2004-101880_Example02P.txt", "JP2014-209144_Example02P.txt",
                                           "JP2019-152887_Example03P-Nikon-400mm-f2.8FL.txt",
                                           "US20190353880_Example01P.txt"};
  int read = 0;
  for (const char* folder : {"lenses/opticalbench-goptical", "lenses/opticalbench-jfotoptix"}) {
    const auto path = shared_data(folder);
    if (!path) return;
    for (const auto& entry : std::filesystem::directory_iterator(*path)) {
      if (entry.path().extension() != ".txt") continue;
      const std::string file = entry.path().filename().string();
      CAPTURE(file);
      const auto lens = read_lens(entry.path());
      REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
      CHECK(lens->warnings.empty() == !kCrossing.contains(file));
      const auto state = configure_lens(*lens);
      REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
      for (const ZoomPosition& position : lens->zoom) {
        const auto zoomed = configure_lens(*lens, {.focal_length_mm = position.focal_length_mm});
        REQUIRE_MESSAGE(zoomed.has_value(), (zoomed ? "" : zoomed.error().to_string()));
        CHECK(zoomed->focal_length_mm == test::approx(position.focal_length_mm).epsilon(0.02));
      }
      const FirstOrder figures = first_order(*state, kLineD_nm);
      CHECK(figures.focal_length_mm == test::approx(*lens->stated.focal_length_mm).epsilon(0.02));
      if (lens->stated.back_focal_distance_mm)
        CHECK(figures.back_focal_distance_mm == test::approx(*lens->stated.back_focal_distance_mm).epsilon(0.02));
      ++read;
    }
  }
  CHECK(read == 24);
}

}  // namespace contrejour::test::optical_bench
