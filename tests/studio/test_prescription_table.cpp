// SPDX-License-Identifier: Apache-2.0
// The table that one types in, against the prescription behind it.
#include <doctest/doctest.h>

#include "contrejour/lens.h"
#include "studio/core/prescription_table.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

Prescription lens_called(const char* name) { return *find_lens(name); }

TEST_CASE("typing a cell's own text changes nothing, in every bundled lens") {
  for (const BundledLens& bundled : bundled_lenses()) {
    const Prescription lens = lens_called(std::string(bundled.name).c_str());
    for (std::size_t row = 0; row < lens.surfaces.size(); ++row)
      for (const LensColumn column :
           {LensColumn::Radius, LensColumn::Thickness, LensColumn::SemiDiameter, LensColumn::Conic}) {
        if (!is_editable(lens, row, column)) continue;
        const std::string text = cell_text(lens, row, column);
        const auto again = with_cell(lens, row, column, text);
        INFO(bundled.name, " surface ", row + 1, " \"", text, "\"");
        REQUIRE(again);
        CHECK(cell_text(*again, row, column) == text);
        CHECK(again->surfaces[row].curvature_per_mm == test::approx(lens.surfaces[row].curvature_per_mm).epsilon(1e-7));
      }
  }
}

TEST_CASE("a cell sets its own number, and what is wrong says why") {
  const Prescription lens = lens_called("heliar");
  const auto edited = with_cell(lens, 0, LensColumn::Radius, "31.5");
  REQUIRE(edited);
  CHECK(1 / edited->surfaces[0].curvature_per_mm == test::approx(31.5));
  CHECK(with_cell(lens, 0, LensColumn::Radius, "plane")->surfaces[0].curvature_per_mm == 0);
  const auto glass = with_cell(lens, 0, LensColumn::Glass, "N-BK7");
  REQUIRE(glass);
  CHECK(refractive_index(glass->surfaces[0].glass_after, kLineD_nm) == test::approx(1.5168).epsilon(1e-4));
  CHECK(with_cell(lens, 0, LensColumn::Glass, "1.62,36.4"));
  const auto unknown = with_cell(lens, 0, LensColumn::Glass, "N-BK8x");
  REQUIRE_FALSE(unknown);
  CHECK(unknown.error().message.find("N-BK8x") != std::string::npos);
  CHECK_FALSE(with_cell(lens, 0, LensColumn::Radius, "wide"));
  CHECK_FALSE(with_cell(lens, 0, LensColumn::Thickness, "-1"));
  CHECK_FALSE(with_cell(lens, lens.surfaces.size() - 1, LensColumn::Thickness, "1"));
  CHECK_FALSE(with_cell(lens, 99, LensColumn::Radius, "1"));
}

TEST_CASE("errors of an edited lens name the surface and no file, and unknown glasses those that are near") {
  Prescription lens = lens_called("heliar");
  const auto steep = with_cell(lens, 0, LensColumn::Radius, "3");
  REQUIRE_FALSE(steep);
  const std::string message = steep.error().to_string();
  CHECK(message.starts_with("surface 1: radius 3 mm is smaller than the semi-diameter"));
  const auto banana = with_cell(lens, 0, LensColumn::Glass, "BANANA");
  REQUIRE_FALSE(banana);
  CHECK(banana.error().message.find("contrejour") == std::string::npos);
  CHECK(banana.error().message.find("BA") != std::string::npos);
  const auto nothing = with_cell(lens, 0, LensColumn::Glass, "!!!!!!!!!!");
  REQUIRE_FALSE(nothing);
  CHECK(nothing.error().message.find("contrejour") == std::string::npos);
}

TEST_CASE("a surface that is inserted and deleted leaves the lens as it was") {
  for (const char* name : {"heliar", "nikon-80-200"}) {
    const Prescription lens = lens_called(name);
    const auto longer = with_inserted_surface(lens, 0);
    REQUIRE(longer);
    CHECK(longer->surfaces.size() == lens.surfaces.size() + 1);
    CHECK(configure_lens(*longer)->focal_length_mm ==
          test::approx(configure_lens(lens)->focal_length_mm).epsilon(1e-9));
    const auto back = without_surface(*longer, 1);
    REQUIRE(back);
    CHECK(write_lens_toml(*back) == write_lens_toml(lens));
  }
}

TEST_CASE("a lens without its stop is refused") {
  const Prescription lens = lens_called("heliar");
  const LensState state = *configure_lens(lens);
  CHECK_FALSE(without_surface(lens, static_cast<std::size_t>(state.stop_index)));
}

TEST_CASE("a lens reversed twice is itself; reversed once it has the same focal length") {
  Prescription lens = lens_called("heliar");
  lens.sensor_distance_mm.reset();
  lens.stated = {};
  const auto once = reversed_lens(lens);
  REQUIRE(once);
  CHECK(configure_lens(*once)->focal_length_mm == test::approx(configure_lens(lens)->focal_length_mm).epsilon(1e-6));
  const auto twice = reversed_lens(*once);
  REQUIRE(twice);
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
    CHECK(twice->surfaces[k].curvature_per_mm == lens.surfaces[k].curvature_per_mm);
  CHECK_FALSE(reversed_lens(lens_called("nikon-80-200")));
}

TEST_CASE("a lens scaled by two has twice the focal length") {
  const Prescription lens = lens_called("canon-rf-50");
  const auto scaled = scaled_lens(lens, 2);
  REQUIRE(scaled);
  CHECK(configure_lens(*scaled)->focal_length_mm ==
        test::approx(2 * configure_lens(lens)->focal_length_mm).epsilon(1e-6));
  CHECK_FALSE(scaled_lens(lens, 0));
  CHECK_FALSE(scaled_lens(lens, -1));
}

TEST_CASE("glasses are completed by their beginning, in any case") {
  const auto names = glasses_like("n-bk", 5);
  REQUIRE_FALSE(names.empty());
  CHECK(names.size() <= 5);
  for (const std::string& name : names) CHECK(name.starts_with("N-BK"));
  CHECK(glasses_like("no such glass", 5).empty());
  CHECK(glasses_near("N-BK7zz", 3).front() == "N-BK7");
  CHECK(glasses_near("!", 3).empty());
}

}  // namespace
}  // namespace contrejour::studio
