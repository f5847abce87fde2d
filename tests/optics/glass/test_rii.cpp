// SPDX-License-Identifier: Apache-2.0
// Pages of refractiveindex.info: reading, and malicious files.
#include <chrono>
#include <cmath>

#include "contrejour/expert/glass_catalogue.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::rii {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPatience_s = 10.0;

CatalogueEntry read(const std::string& text) {
  auto file = read_glass_yaml(text, "x.yml", "MAKER", "NAME");
  REQUIRE_MESSAGE(file.has_value(), file.error().to_string());
  REQUIRE(file->glasses.size() == 1);
  return std::move(file->glasses[0]);
}

const GlassData& data_of(const CatalogueEntry& entry) {
  return std::get<CatalogueGlass>(entry.glass.dispersion).data();
}

// Made for this test, in the form of the database.
constexpr const char* kPage =
    "REFERENCES: |\n    a book\n"
    "DATA:\n"
    "  - type: formula 2\n"
    "    wavelength_range: 0.3 2.5\n"
    "    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n"
    "  - type: tabulated k\n"
    "    data: |\n"
    "        0.300 2.8E-06\n"
    "        0.500 1.0E-08\n"
    "CONDITIONS:\n"
    "    temperature: 295\n"
    "PROPERTIES:\n"
    "    thermal_dispersion:\n"
    "      - type: formula A\n"
    "        coefficients: 1.86e-06 1.31e-08 -1.37e-11 4.34e-07 6.27e-10 0.17\n"
    "    nd: 1.5168\n"
    "    Vd: 64.17\n"
    "    glass_code: 517642.251\n"
    "    glass_status: preferred\n";

TEST_CASE("everything that a page says") {
  const CatalogueEntry entry = read(kPage);
  const GlassData& data = data_of(entry);
  CHECK(data.formula == DispersionFormula::Rii2);
  CHECK(data.range_nm == WavelengthRange{300.0, 2500.0});
  CHECK(data.thermal == ThermalDispersion{1.86e-6, 1.31e-8, -1.37e-11, 4.34e-7, 6.27e-10, 0.17});
  CHECK(data.reference_temperature_c == 22.0);
  CHECK_FALSE(data.index_in_vacuum);
  CHECK(refractive_index(entry.glass, kLineD_nm) == test::approx(1.5168).epsilon(1e-6));
  CHECK(entry.summary.code == "517642.251");
  CHECK(entry.summary.status == GlassStatus::Preferred);
  CHECK(entry.summary.v_d == 64.17);
  CHECK(entry.summary.maker == "MAKER");
  // k = 1e-8 at 500 nm: 4 pi 1e-8 / 500e-6 per mm.
  CHECK(internal_transmittance(entry.glass, 500.0, 100.0) ==
        test::approx(std::exp(-4 * 3.14159265358979 * 1e-8 / 5e-4 * 100)));
}

TEST_CASE("tables of n, of n and k, rows that fall, wavelengths twice") {
  const CatalogueEntry entry = read(
      "DATA:\n  - type: tabulated nk\n    data: |\n        0.7 1.5 0.001\n        0.5 1.6 0.002\n        0.5 1.7 "
      "0.003\n");
  CHECK(refractive_index(entry.glass, 500.0) == 1.6);
  CHECK(refractive_index(entry.glass, 700.0) == 1.5);
  CHECK(data_of(entry).absorption.size() == 2);
  CHECK(internal_transmittance(entry.glass, 500.0, 0.01) ==
        test::approx(std::exp(-4 * 3.14159265358979 * 0.002 / 5e-4 * 0.01)));
  CHECK(read("DATA:\n  - type: tabulated n\n    data: |\n        0.4 1.6\n        0.7 1.5\n").summary.n_d > 1.5);
}

TEST_CASE("index and wavelength against vacuum") {
  const double in_air = refractive_index(read(kPage).glass, 500.0);
  const CatalogueEntry vacuum =
      read(std::string(kPage) + "SPECS:\n    n_is_absolute: true\n    wavelength_is_vacuum: true\n");
  CHECK(data_of(vacuum).index_in_vacuum);
  CHECK(data_of(vacuum).wavelength_in_vacuum);
  CHECK(in_air - refractive_index(vacuum.glass, 500.0) == test::approx(1.52 * 2.7e-4).epsilon(0.1));
  CHECK(data_of(read("SPECS:\n    temperature: \"25.0 \u00b0C\"\n" +
                     std::string("DATA:\n  - type: formula 5\n    coefficients: 1.5\n    wavelength_range: 0.4 0.7\n")))
            .reference_temperature_c == 25.0);
}

void check_refused(const std::string& text, const std::string& words, int line = 0) {
  const auto begin = Clock::now();
  const auto file = read_glass_yaml(text, "x.yml", "M", "N");
  CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < kPatience_s);
  CAPTURE(text.substr(0, 200));
  REQUIRE_FALSE(file.has_value());
  CAPTURE(file.error().message);
  CHECK(file.error().message.find(words) != std::string::npos);
  CHECK(file.error().message.size() < 1000);
  CHECK(file.error().position.file == "x.yml");
  if (line != 0) CHECK(file.error().position.line == line);
}

std::string formula(const std::string& type, const std::string& coefficients, const std::string& range = "0.4 0.7") {
  return "DATA:\n  - type: " + type + "\n    wavelength_range: " + range + "\n    coefficients: " + coefficients + "\n";
}

TEST_CASE("what is no glass") {
  CHECK(read_glass_yaml(formula("formula 5", "1.5"), "x.yml", "M", "N").has_value());
  check_refused("", "no DATA");
  check_refused("ABOUT: x\n", "no DATA");
  check_refused("DATA: 5\n", "no DATA");
  check_refused("DATA:\n  - 5\n", "no type");
  check_refused("DATA:\n  - type: tabulated k\n    data: |\n        0.5 1e-8\n", "does not tell the refractive index");
  check_refused("DATA:\n  - type: formula A\n    coefficients: 1 2\n", "does not tell the refractive index");
  check_refused(formula("formula 10", "1.5"), "not a type that is known", 2);
  check_refused(formula("formula 5", "nan"), "not a number", 4);
  check_refused(formula("formula 5", "1.5 inf 1"), "not a number", 4);
  check_refused(formula("formula 5", "1,5 x"), "not a number", 4);
  check_refused(formula("formula 5", "1.5 2"), "odd number");
  check_refused(formula("formula 4", "1.5"), "1 coefficients");
  check_refused(formula("formula 3", "-2"), "index is");
  check_refused(formula("formula 5", "1.5", "0.7 0.4"), "range");
  check_refused(formula("formula 5", "1.5", "0.7"), "two wavelengths", 2);
  check_refused(
      formula("formula 5", "1.5") + "  - type: formula 5\n    wavelength_range: 0.4 0.7\n    coefficients: 1.6\n",
      "second", 5);
  check_refused("DATA:\n  - type: tabulated n\n    data: |\n        0.5 1.5\n        0.6\n", "rows of 2");
  check_refused("DATA:\n  - type: tabulated n\n", "data is missing");
  check_refused("DATA:\n  - type: tabulated n\n    data: |\n        0.5 1.5\n        0.6 x\n", "not a number");
  check_refused("DATA: [\n", "not valid YAML");
  check_refused(std::string(2U << 20U, 'x'), "at most");
  check_refused(std::string(100'000, '['), "nested deeper");
}

TEST_CASE("a page cut at each byte") {
  const std::string text = kPage;
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto file = read_glass_yaml(text.substr(0, size), "x.yml", "M", "N");
    if (file) CHECK(refractive_index(file->glasses.at(0).glass, 550.0) > 0.0);
  }
}

// Every available page is read, or refused because it has no n, or because its n is impossible.
TEST_CASE("all pages at hand [slow]") {
  const auto folder = shared_data("glass/refractiveindex.info/database/data");
  if (!folder) return;
  int read_ones = 0, without_n = 0, other_pages = 0;
  std::vector<std::string> impossible;
  for (const auto& at : std::filesystem::recursive_directory_iterator(*folder)) {
    if (at.path().extension() != ".yml") continue;
    const auto file = read_glass_file(at.path());
    if (file) {
      ++read_ones;
      continue;
    }
    const std::string& message = file.error().message;
    CAPTURE(file.error().to_string());
    const bool about = at.path().filename() == "about.yml";
    const bool no_n = message.find("does not tell the refractive index") != std::string::npos;
    const bool negative = message.find("the index is -") != std::string::npos;
    CHECK(int{about} + int{no_n} + int{negative} == 1);
    (about ? other_pages : without_n) += negative ? 0 : 1;
    if (negative) impossible.push_back(at.path().stem().string());
  }
  std::sort(impossible.begin(), impossible.end());
  // Isuzu's filter glasses: powers of the wavelength that the database uses far outside the range of the fit.
  CHECK(impossible == std::vector<std::string>{"IEB400", "IHU340", "IHU350", "ISK153", "ISK370", "IVG540"});
  CHECK(read_ones == 1875);
  CHECK(without_n == 61);  // n2 pages and four of k alone
  CHECK(other_pages == 33);
}

}  // namespace
}  // namespace contrejour::test::rii
