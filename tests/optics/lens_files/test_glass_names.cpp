// SPDX-License-Identifier: Apache-2.0
// Glasses by their catalogue names in lens files, formulas in braces, and both through the writer.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/lens.h"

namespace contrejour::test::glass_names {
namespace {

std::string lens_with(const std::string& glass, const std::string& tables = "") {
  return fmt::format(
      "name = \"x\"\nsource = \"x\"\nf_number = 4\nsensor_mm = [36, 24]\nsurfaces = [\n"
      "  {{ radius_mm = 60, thickness_mm = 5, semi_diameter_mm = 10, glass = {} }},\n"
      "  {{ radius_mm = -60, thickness_mm = 2, semi_diameter_mm = 10 }},\n"
      "  {{ stop = true, semi_diameter_mm = 8 }},\n]\n{}",
      glass, tables);
}

Prescription read(const std::string& text, const GlassCatalogue* own = nullptr) {
  auto lens = read_lens_toml(text, "x.toml", own);
  REQUIRE_MESSAGE(lens.has_value(), lens.error().to_string());
  return std::move(*lens);
}

Glass glass_of(const std::string& glass, const std::string& tables = "") {
  return read(lens_with(glass, tables)).surfaces[0].glass_after;
}

constexpr const char* kEveryFormula[] = {
    R"({ n_d = 1.6, v_d = 60, d_pgf = 0.003 })",
    R"({ name = "own", formula = "schott", coefficients = [2.2, -0.01, 0.01, 1e-4] })",
    R"({ formula = "sellmeier-2", coefficients = [0.3, 0.9, 0.1, -1, 10], range_nm = [300, 2000] })",
    R"({ formula = "conrady", coefficients = [1.45, 0.0125, 0.0002], temperature_c = 25.5 })",
    R"({ formula = "rii-3", coefficients = [2.2, -0.01, 2, 0.01, -2], thermal = [1e-6, 0, 0, 4e-7, 0, 0.2] })",
    R"({ formula = "table", coefficients = [0.38, 1.62, 0.5, 1.6, 0.78, 1.59], absorption_per_mm = [400, 0.01, 500, 0.001] })",
    R"({ formula = "cauchy", coefficients = [1.5, 0.004], index_in_vacuum = true, wavelength_in_vacuum = true })",
    R"("SCHOTT N-BK7")",
    R"("517642")",
    R"("nsf6")",
};

TEST_CASE("every way to name a glass reads, writes and reads back the same") {
  for (const char* text : kEveryFormula) {
    CAPTURE(text);
    const Prescription lens = read(lens_with(text));
    const std::string written = write_lens_toml(lens);
    CAPTURE(written);
    const Prescription again = read(written);
    CHECK(again.surfaces[0].glass_after == lens.surfaces[0].glass_after);
    CHECK(write_lens_toml(again) == written);
  }
}

TEST_CASE("catalogue glasses: one catalogue, whatever the spelling; written by name") {
  const GlassCatalogue bundled = bundled_glasses();
  const Glass bk7 = bundled.find("N-BK7")->glass;
  CHECK(glass_of("\"n-bk7\"").dispersion == bk7.dispersion);
  CHECK(glass_of("\"n-bk7\"").name == "n-bk7");
  CHECK(glass_of("\"SCHOTT N-BK7\"").dispersion == bk7.dispersion);
  CHECK(write_lens_toml(read(lens_with("\"N-BK7\""))).find("glass = \"N-BK7\"") != std::string::npos);
  CHECK(write_lens_toml(read(lens_with("\"N-BK7\""))).find("[glass]") == std::string::npos);
}

TEST_CASE("a file's own [glass] comes before the catalogues") {
  CHECK(glass_of("\"N-BK7\"", "[glass]\nN-BK7 = { n = 1.7 }\n").dispersion ==
        decltype(Glass::dispersion)(ConstantIndex{1.7}));
  // The same holds for written files: two glasses of one name, of which one is the catalogue's.
  Prescription lens = read(lens_with("\"N-BK7\""));
  lens.surfaces.insert(lens.surfaces.begin() + 2, lens.surfaces.begin(), lens.surfaces.begin() + 2);
  lens.surfaces[2].glass_after = {"N-BK7", ConstantIndex{1.7}};
  lens.surfaces[1].thickness_mm = 20;
  for (int order = 0; order < 2; ++order) {
    const Prescription again = read(write_lens_toml(lens));
    CHECK(again.surfaces[0].glass_after == lens.surfaces[0].glass_after);
    CHECK(again.surfaces[2].glass_after == lens.surfaces[2].glass_after);
    std::swap(lens.surfaces[0].glass_after, lens.surfaces[2].glass_after);
  }
}

TEST_CASE("a caller's own catalogue comes before the bundled one, and its glass is written whole") {
  GlassCatalogue own;
  GlassData data;
  data.formula = DispersionFormula::Cauchy;
  data.coefficients = {1.7, 0.004};
  own.add({{{"N-BK7", "MINE", "", GlassStatus::Standard, 1.71, 60.0}, {"N-BK7", CatalogueGlass(data)}, "mine.agf"}});
  const Prescription lens = read(lens_with("\"N-BK7\""), &own);
  CHECK(std::abs(refractive_index(lens.surfaces[0].glass_after, 500.0) - 1.716) < 1e-12);
  const Prescription again = read(write_lens_toml(lens));  // without the catalogue
  CHECK(again.surfaces[0].glass_after == lens.surfaces[0].glass_after);
}

void check_refused(const std::string& glass, const std::string& words, const std::string& tables = "") {
  const auto lens = read_lens_toml(lens_with(glass, tables), "x.toml");
  CAPTURE(glass);
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().to_string());
  CHECK(lens.error().message.find(words) != std::string::npos);
  CHECK(lens.error().position.line > 0);
}

TEST_CASE("what is refused, with what to do") {
  check_refused("\"N-BK77X\"", "did you mean 'N-BK7");
  check_refused("\"qqqqqqqqqq\"", "add it under [glass]");
  check_refused("\"Crow\"", "did you mean 'Crown'?", "[glass]\nCrown = { n = 1.5 }\n");
  check_refused(R"({ formula = "shott", coefficients = [2.2] })", "did you mean 'schott'");
  check_refused(R"({ formula = "schott" })", "coefficients must be a list");
  check_refused(R"({ formula = "schott", coefficients = [1, 2, 3, 4, 5, 6, 7] })", "7 coefficients");
  check_refused(R"({ formula = "schott", coefficients = [nan] })", "coefficients");
  check_refused(R"({ formula = "schott", coefficients = [-2.2] })", "index is");
  check_refused(R"({ formula = "schott", coefficients = [90] })", "from 1 to 5");
  check_refused(R"({ formula = "schott", coefficients = [2.2], range_nm = [400] })", "range_nm must be a list of 2");
  check_refused(R"({ formula = "schott", coefficients = [2.2], thermal = [1] })", "thermal must be a list of 6");
  check_refused(R"({ formula = "schott", coefficients = [2.2], absorption_per_mm = [1, 2, 3] })", "pairs");
  check_refused(R"({ formula = "schott", coefficients = [2.2], n = 1.5 })", "n");
  check_refused(R"({ n_d = 1.5, d_pgf = 0.1 })", "v_d");
  check_refused(R"({ n_d = 1.5, v_d = 60, d_pgf = 9 })", "deviation");
}

TEST_CASE("a formula beyond where it holds is a warning") {
  const auto warnings = [](const std::string& range) {
    const auto state = configure_lens(
        read(lens_with(fmt::format("{{ formula = \"schott\", coefficients = [2.25], range_nm = {} }}", range))));
    REQUIRE(state.has_value());
    return state->warnings;
  };
  CHECK(warnings("[400, 700]").empty());
  REQUIRE(warnings("[480, 700]").size() == 1);
  CHECK(warnings("[480, 700]")[0].find("surface 1: the formula of its glass holds from 480 to 700 nm") !=
        std::string::npos);
  CHECK(warnings("[400, 650]").size() == 1);
}

}  // namespace
}  // namespace contrejour::test::glass_names
