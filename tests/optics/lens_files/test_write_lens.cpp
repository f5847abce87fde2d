// SPDX-License-Identifier: Apache-2.0
// Zemax and CODE V files that we write: read again, they give the same lens.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "contrejour/expert/write_lens.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/same_lens.h"
#include "optics/lens_files/sample_lens.h"
#include "shared_data.h"

namespace contrejour::test::write_lens {
namespace {

Prescription toml(const std::string& text) {
  const auto lens = read_lens_toml(text, "a.toml");
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  return *lens;
}

using WriteLens = Result<WrittenLens> (*)(const Prescription&);
using ReadLens = Result<Prescription> (*)(const LensText&);
struct Format {
  const char* name;
  WriteLens write;
  ReadLens read;
};
constexpr Format kFormats[] = {{"a.zmx", write_lens_zmx, read_zmx}, {"a.seq", write_lens_seq, read_seq}};

// Writes a lens and reads it again; does nothing if the format cannot hold it.
void check_round_trip(const Prescription& lens, const Format& format, const SameLens& how = {}) {
  CAPTURE(format.name);
  const auto written = format.write(lens);
  REQUIRE_MESSAGE(written.has_value(), (written ? "" : written.error().to_string()));
  const auto again = format.read({written->text, format.name});
  REQUIRE_MESSAGE(again.has_value(), (again ? "" : again.error().to_string()));
  check_same_lens(lens, *again, how);
  const auto twice = format.write(*again);
  REQUIRE(twice.has_value());
  CHECK(twice->text.size() > 100);
}

std::string row_as(const std::string& more) {
  return edited("{ radius_mm = inf, thickness_mm = 4.0, semi_diameter_mm = 9.0, glass = \"SF2\" }",
                "{ radius_mm = 90.3, thickness_mm = 4.0, semi_diameter_mm = 9.0, glass = \"SF2\"" + more + " }");
}

}  // namespace

TEST_CASE("a lens written for Zemax or CODE V and read again is the same") {
  for (const Format& format : kFormats) {
    check_round_trip(toml(kSampleLens), format);
    check_round_trip(toml(edited("focal_length_mm = 50, thickness_mm = { 2 = 3.0 }",
                                 "focal_length_mm = 89, thickness_mm = { 2 = 4.0 }",
                                 edited("focal_length_mm = 60, thickness_mm = { 2 = 4.0 }",
                                        "focal_length_mm = 91.5, thickness_mm = { 2 = 3.0 }", zoom_sample()))),
                     format);
    check_round_trip(toml(edited("sensor_mm = [36, 24]", "sensor_mm = [24.89, 18.66]")), format);
    check_round_trip(toml(row_as(", conic = -1.25, asphere = { 4 = -1.1e-6, 6 = 2.2e-9 }")), format);
    check_round_trip(toml(row_as(", asphere = { 4 = -1.1e-6, 20 = 2.2e-28 }")), format);
    check_round_trip(toml(row_as(", conic = -1.25, toroid = { radius_x_mm = inf }")), format);
    check_round_trip(toml(row_as(", toroid = { radius_x_mm = 33.3, turn_deg = 90 }")), format);
    check_round_trip(toml(row_as(", asphere = { 4 = 1e-7 }, toroid = { radius_x_mm = 71.7, turn_deg = 30 }")), format);
    check_round_trip(toml(row_as(", conic = -1, biconic = { radius_x_mm = 71.7, conic_x = -2 }")), format);
    check_round_trip(toml(row_as(", decentre_mm = [0.1, 0.2], tilt_deg = [1, -2]")), format);
    check_round_trip(toml(row_as(", rectangle = { half_sides_mm = [5, 3] }")), format);
    check_round_trip(toml(row_as(", ellipse = { semi_axes_mm = [5, 3], centre_mm = [0.5, 1], turn_deg = 30 }")),
                     format);
    check_round_trip(toml(row_as(", toroid = { radius_x_mm = 50, turn_deg = 30 }, tilt_deg = [1, 2], "
                                 "rectangle = { half_sides_mm = [5, 3], centre_mm = [0.5, 1], turn_deg = 30 }")),
                     format);
    check_round_trip(toml(row_as(", obscuration = { semi_axes_mm = [3, 3] }")), format);
    check_round_trip(toml(row_as(", obscuration = { semi_axes_mm = [3, 3], centre_mm = [0.5, 1] }")), format);
    check_round_trip(toml(row_as(", obscuration = { semi_axes_mm = [3, 2], centre_mm = [0.5, 1], turn_deg = 30 }")),
                     format);
    check_round_trip(toml(row_as(", toroid = { radius_x_mm = 50, turn_deg = 30 }, tilt_deg = [1, 2], "
                                 "obscuration = { semi_axes_mm = [3, 2], turn_deg = 30 }")),
                     format);
    check_round_trip(toml(edited("stop = true", "stop = true, obscuration = { semi_axes_mm = [2, 2] }")), format);
    check_round_trip(toml(row_as(", toroid = { radius_x_mm = inf, turn_deg = 20 }, tilt_deg = [1, -2]")), format);
  }
  check_round_trip(toml(row_as(", decentre_mm = [0.1, 0.2, 0.3], tilt_deg = [1, -2]")), kFormats[1]);
  check_round_trip(toml(row_as(", asphere = { 3 = 1e-6, 4 = -1.1e-6 }")), kFormats[0]);
  check_round_trip(toml(row_as(", asphere = { 2 = 1e-5, 3 = 1e-6, 11 = -1.1e-16 }")), kFormats[0]);
}

TEST_CASE("glasses of every kind, as near as the formats have them") {
  const auto with = [](const std::string& glass) {
    return toml(edited("BK7 = { n_d = 1.5168, v_d = 64.17 }", "BK7 = " + glass));
  };
  for (const Format& format : kFormats) {
    check_round_trip(with("{ n = 1.5 }"), format);
    check_round_trip(with("{ n_d = 1.52, v_d = 0 }"), format);
    check_round_trip(with("{ n_d = 1.62, v_d = 36.4, d_pgf = 0.0 }"), format);
    check_round_trip(with("{ n_d = 1.62, v_d = 36.4, d_pgf = 0.0021 }"), format, {.index = 1e-6});
    check_round_trip(with("{ sellmeier_b = [1.03961212, 0.231792344, 1.01046945], sellmeier_c_um2 = [0.00600069867, "
                          "0.0200179144, 103.560653] }"),
                     format, {.index = format.write == write_lens_zmx ? 2e-4 : 1e-12});
    const std::string named =
        edited("glass = \"BK7\"", "glass = \"SCHOTT N-LAK22\"", edited("BK7 = { n_d = 1.5168, v_d = 64.17 }\n", ""));
    check_round_trip(toml(named), format, {.index = 1e-15});
    CHECK(format.write(toml(named))->text.find(format.write == write_lens_zmx ? "N-LAK22" : "NLAK22_SCHOTT") !=
          std::string::npos);
  }
}

TEST_CASE("what the formats cannot hold is said") {
  const auto losses = [](const Format& format, const std::string& text) {
    std::string all;
    const auto written = format.write(toml(text));
    for (const std::string& loss : written->losses) all += loss + "\n";
    return all;
  };
  const std::string coated = row_as(", coating = \"quarter-wave\"");
  for (const Format& format : kFormats) {
    CHECK(losses(format, coated).find("the coatings of 1 surfaces") != std::string::npos);
    CHECK(losses(format, kSampleLens).find("stated focal length") != std::string::npos);
  }
  const auto refused = [](const Format& format, const std::string& text, const std::string& words) {
    const auto written = format.write(toml(text));
    REQUIRE_FALSE(written.has_value());
    CHECK(written.error().message.find(words) != std::string::npos);
    CHECK(written.error().position.line == 9);
  };
  refused(kFormats[0], row_as(", asphere = { 3 = 1e-7 }, toroid = { radius_x_mm = 71.7 }"),
          "surface 4: a toroid's polynomial");
  refused(kFormats[0], row_as(", toroid = { radius_x_mm = 50 }, rectangle = { half_sides_mm = [5, 3], turn_deg = 30 }"),
          "surface 4: its rim is turned");
  refused(kFormats[0], row_as(", rectangle = { half_sides_mm = [5, 3] }, obscuration = { semi_axes_mm = [1, 1] }"),
          "surface 4: a rim that is no circle and an obscuration");
  check_round_trip(toml(row_as(", rectangle = { half_sides_mm = [5, 3] }, obscuration = { semi_axes_mm = [1, 1] }")),
                   kFormats[1]);
  CHECK(losses(kFormats[0], row_as(", rectangle = { half_sides_mm = [8, 8] }")).find("written whole") !=
        std::string::npos);
  refused(kFormats[1], row_as(", asphere = { 3 = 1e-6 }"), "surface 4: a polynomial with r^3");
  refused(kFormats[1], row_as(", asphere = { 2 = 1e-6 }"), "surface 4: a polynomial with r^2");
  Prescription broken = toml(kSampleLens);
  broken.surfaces.clear();
  for (const Format& format : kFormats) CHECK_FALSE(format.write(broken).has_value());
}

TEST_CASE("every bundled lens is the same through Zemax and CODE V") {
  for (const BundledLens& bundled : bundled_lenses()) {
    CAPTURE(bundled.name);
    const Prescription lens = toml(std::string(bundled.toml));
    // Zemax has Sellmeier's formula only through glass names.
    for (const Format& format : kFormats)
      check_round_trip(lens, format, {.index = format.write == write_lens_zmx ? 2e-4 : 1e-12});
  }
}

TEST_CASE("every sample that is read is the same through Zemax and CODE V [slow]") {
  const auto folder = shared_data("lenses");
  if (!folder) return;
  int written = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".zmx" && extension != ".seq" && extension != ".txt") continue;
    const auto lens = read_lens(entry.path());
    if (!lens) continue;
    CAPTURE(entry.path().filename().string());
    for (const Format& format : kFormats) {
      const auto text = format.write(*lens);
      if (!text) continue;
      // A model glass replaces a formula or, at worst, a few measured indices of four digits.
      check_round_trip(*lens, format, {.index = 4e-4});
      ++written;
    }
  }
  CHECK(written > 80);
}

}  // namespace contrejour::test::write_lens
