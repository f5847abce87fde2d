// SPDX-License-Identifier: Apache-2.0
// The values of a correct file are read as written.
#include "optics/lens_files/sample_lens.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "contrejour/lens.h"
#include "support/approx.h"

namespace contrejour::test::toml_values {
namespace {

Prescription read(const std::string& text) {
  const auto lens = read_lens_toml(text, "x.toml");
  if (!lens) FAIL(lens.error().to_string());
  return *lens;
}

TEST_CASE("values of the sample") {
  const Prescription lens = read(kSampleLens);
  CHECK(lens.name == "Sample");
  CHECK(lens.f_number == 4.0);
  CHECK(lens.sensor_width_mm == 36.0);
  CHECK(lens.file.file == "x.toml");
  CHECK(lens.stated.focal_length_mm == 60.0);
  CHECK_FALSE(lens.stated.back_focal_distance_mm.has_value());
  CHECK(lens.stated.wavelength_nm == kLineD_nm);
  REQUIRE(lens.surfaces.size() == 5);
  CHECK(lens.surfaces[0].curvature_per_mm == 1.0 / 50.0);
  CHECK(lens.surfaces[0].glass_after == Glass{"BK7", AbbeGlass{1.5168, 64.17}});
  CHECK(lens.surfaces[1].glass_after == air());
  CHECK(lens.surfaces[1].source_line == 7);
  CHECK(lens.surfaces[2].kind == SurfaceKind::Stop);
  CHECK(lens.surfaces[2].glass_after == air());
  CHECK(lens.surfaces[3].curvature_per_mm == 0.0);
  CHECK(lens.surfaces[4].thickness_mm == 0.0);
}

TEST_CASE("the default coating covers glass to air only, and gives way to a row's own") {
  std::string text = edited("sensor_mm", "default_coating = { quarter_wave_nm = 500, n = 1.4 }\nsensor_mm");
  // Surfaces 1 and 2 are cemented to a flint, whose rear face says "none".
  text = edited("semi_diameter_mm = 10.0 },",
                "semi_diameter_mm = 10.0, glass = \"SF2\" },\n  { radius_mm = inf, "
                "thickness_mm = 2.0, semi_diameter_mm = 9.0, coating = \"none\" },",
                text);
  const Prescription lens = read(text);
  REQUIRE(lens.surfaces.size() == 6);
  const Coating film{"", QuarterWave{1.4, 500.0}};
  CHECK(lens.surfaces[0].coating == film);
  CHECK(lens.surfaces[1].coating == Coating{});
  CHECK(lens.surfaces[2].coating == Coating{});
  CHECK(lens.surfaces[3].coating == Coating{});
  CHECK(lens.surfaces[4].coating == film);
  CHECK(lens.surfaces[5].coating == film);
}

TEST_CASE("every kind of coating and glass") {
  const auto coating_of = [](const std::string& value) {
    return read(edited("glass = \"BK7\"", fmt::format("glass = \"BK7\", coating = {}", value))).surfaces[0].coating;
  };
  CHECK(coating_of("\"none\"") == Coating{});
  CHECK(coating_of("\"quarter-wave\"") == Coating{"", QuarterWave{1.38, 550.0}});
  CHECK(coating_of("{ quarter_wave_nm = 480 }") == Coating{"", QuarterWave{1.38, 480.0}});
  CHECK(coating_of("{ hullin_nm = 480, n = 1.45, name = \"h\" }") == Coating{"h", HullinFresnelAR{1.45, 480.0}});
  CHECK(coating_of("{ layers = [{ n = 1.38, thickness_nm = 90 }, { n = 2, k = 0.1, thickness_nm = 5 }] }") ==
        Coating{"", FilmStack{{{{1.38, 0.0}, 90.0}, {{2.0, 0.1}, 5.0}}}});
  CHECK(coating_of("\"broadband-6\"") == Coating{"", DesignedCoating{CoatingDesign::Broadband, 550.0, 6}});
  CHECK(coating_of("{ design = \"v-coat\", design_nm = 480 }") ==
        Coating{"", DesignedCoating{CoatingDesign::VCoat, 480.0}});
  CHECK(coating_of("{ layers = [{ material = \"ZrO2\", thickness_nm = 90 }] }") ==
        Coating{"", FilmStack{{{film_material("ZrO2"), 90.0}}}});
  CHECK(std::get<FilmStack>(coating_of("{ layers = [{ n = 2, waves = 0.5, at_nm = 600 }] }").films)
            .layers[0]
            .thickness_nm == test::approx(150.0));
  CHECK(coating_of("{ measured_nm = [450, 650], measured_deg = [0], reflectance = [0.01, 0.02] }") ==
        Coating{"", MeasuredCoating{{450.0, 650.0}, {0.0}, {0.01, 0.02}}});
  const auto glass_of = [](const std::string& value) {
    return read(edited("glass = \"SF2\"", fmt::format("glass = {}", value),
                       edited("SF2 = { n_d = 1.64769, v_d = 33.85 }\n", "")))
        .surfaces[3]
        .glass_after;
  };
  CHECK(glass_of("{ n = 1.5 }") == Glass{"", ConstantIndex{1.5}});
  CHECK(glass_of("{ n_d = 1.5, v_d = 0 }") == Glass{"", AbbeGlass{1.5, 0.0}});
  CHECK(glass_of("{ name = \"g\", n_d = 1.5, v_d = 60 }") == Glass{"g", AbbeGlass{1.5, 60.0}});
  CHECK(glass_of("{ sellmeier_b = [1, 0.2, 1], sellmeier_c_um2 = [0.006, 0.02, 100] }") ==
        Glass{"", Sellmeier{{1.0, 0.2, 1.0}, {0.006, 0.02, 100.0}}});
}

TEST_CASE("a zoom's gaps come in the order of the surfaces") {
  std::string text = edited("{ 2 = 3.0 }", "{ 4 = 5.0, 2 = 3.0 }", zoom_sample());
  text = edited("{ 2 = 4.0 }", "{ 2 = 4.0, 4 = 6.0 }", text);
  const Prescription lens = read(text);
  REQUIRE(lens.zoom.size() == 2);
  CHECK(lens.zoom[0].focal_length_mm == 50.0);
  CHECK(lens.zoom[0].thickness_mm == std::vector<std::pair<int, double>>{{1, 3.0}, {3, 5.0}});
  CHECK(lens.zoom[1].source_line == 14);
}

TEST_CASE("a byte order mark and Windows line ends change nothing") {
  std::string text = std::string("\xEF\xBB\xBF").append(kSampleLens);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  CHECK(read(text).surfaces[1].source_line == 7);
}

TEST_CASE("rows may be written as tables of their own") {
  const Prescription lens = read(
      "name = \"a\"\nsource = \"b\"\nf_number = 2\nsensor_mm = [3, 2]\n"
      "[[surfaces]]\nradius_mm = 50\nthickness_mm = 3\nsemi_diameter_mm = 5\nglass = { n = 1.5 }\n"
      "[[surfaces]]\nradius_mm = -50\nthickness_mm = 1\nsemi_diameter_mm = 5\n"
      "[[surfaces]]\nstop = true\nsemi_diameter_mm = 4\n");
  CHECK(lens.surfaces.size() == 3);
}

// The format's page shows one complete lens, which must be valid.
TEST_CASE("the example of the format's page") {
  std::ifstream page(CONTREJOUR_SOURCE_DIR "/docs/formats/lens-toml.md");
  REQUIRE(page.good());
  std::stringstream all;
  all << page.rdbuf();
  const std::string text = all.str();
  const std::size_t begin = text.find("```toml\n") + 8;
  const Prescription lens = read(text.substr(begin, text.find("```", begin) - begin));
  CHECK(lens.zoom.size() == 2);
  CHECK(std::holds_alternative<FilmStack>(lens.surfaces[4].coating.films));
  CHECK(configure_lens(lens).has_value());
}

}  // namespace
}  // namespace contrejour::test::toml_values
