// SPDX-License-Identifier: Apache-2.0
// AGF catalogues: reading, writing, and malicious files.
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/decode_text.h"
#include "contrejour/expert/glass_catalogue.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::agf {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPatience_s = 10.0;  // for a sanitizer on a busy machine; a failure would take minutes

// Made for this test, in the form of a catalogue.
constexpr const char* kTwo =
    "CC a catalogue of two\n"
    "NM ONE-K 2 517642.251 1.516800 64.167 0 1 -1\n"
    "GC a crown\n"
    "ED 7.1 8.3 2.51 -0.0009 0\n"
    "CD 1.03961212E+00 6.00069867E-03 2.31792344E-01 2.00179144E-02 1.01046945E+00 1.03560653E+02 0 0 0 0\n"
    "TD 1.86E-06 1.31E-08 -1.37E-11 4.34E-07 6.27E-10 1.7E-01 2.2E+01\n"
    "OD -1 -1 -1 -1 -1 -1\n"
    "LD 3.1E-01 2.5E+00\n"
    "IT 3.1E-01 0.0 2.5E+01\n"
    "IT 4.0E-01 0.992 2.5E+01\n"
    "IT 3.65E-01 9.71E-01 1.0E+01\n"
    "IT 5.0E-01  2.5E+01\n"
    "NM TWO 1 1 1.5 0 0 2 -\n"
    "CD 2.25 0 0 0 0 0\n"
    "TD\n"
    "LD 0.4 0.7\n";

GlassFile read(const std::string& text) {
  auto file = read_agf(text, "x.agf", "MAKER");
  REQUIRE_MESSAGE(file.has_value(), file.error().to_string());
  return std::move(*file);
}

const GlassData& data_of(const CatalogueEntry& entry) {
  return std::get<CatalogueGlass>(entry.glass.dispersion).data();
}

TEST_CASE("everything that a catalogue says") {
  const GlassFile file = read(kTwo);
  CHECK(file.warnings.empty());
  REQUIRE(file.glasses.size() == 2);
  const CatalogueEntry& one = file.glasses[0];
  CHECK(one.summary.name == "ONE-K");
  CHECK(one.summary.maker == "MAKER");
  CHECK(one.summary.code == "517642.251");
  CHECK(one.summary.status == GlassStatus::Preferred);
  CHECK(one.summary.n_d == 1.5168);
  CHECK(one.glass.name == "ONE-K");
  CHECK(one.source == "x.agf");
  const GlassData& data = data_of(one);
  CHECK(data.formula == DispersionFormula::Sellmeier1);
  CHECK(data.coefficients.size() == 6);
  CHECK(data.range_nm == WavelengthRange{310.0, 2500.0});
  CHECK(data.thermal == ThermalDispersion{1.86e-6, 1.31e-8, -1.37e-11, 4.34e-7, 6.27e-10, 0.17});
  CHECK(data.reference_temperature_c == 22.0);
  REQUIRE(data.absorption.size() == 3);  // sorted; the row with a blank is skipped
  CHECK(internal_transmittance(one.glass, 365.0, 10.0) == test::approx(0.971));
  CHECK(internal_transmittance(one.glass, 400.0, 25.0) == test::approx(0.992));
  CHECK(internal_transmittance(one.glass, 310.0, 25.0) == test::approx(0.0005));  // printed 0
  const CatalogueEntry& two = file.glasses[1];
  CHECK(refractive_index(two.glass, 500.0) == 1.5);
  CHECK(two.summary.status == GlassStatus::Obsolete);
  CHECK(two.summary.code == "");
  CHECK_FALSE(data_of(two).thermal.has_value());
}

std::string with_line_ends(std::string_view ends) {
  std::string text;
  for (const char* c = kTwo; *c != '\0'; ++c) text += *c == '\n' ? ends : std::string_view(c, 1);
  return text;
}

TEST_CASE("any line ends, UTF-16, accents in Latin-1") {
  const GlassFile plain = read(kTwo);
  for (const char* ends : {"\r", "\r\n"}) {
    const GlassFile file = read(with_line_ends(ends));
    REQUIRE(file.glasses.size() == 2);
    CHECK(file.glasses[0].glass == plain.glasses[0].glass);
  }
  std::string wide = "\xFF\xFE";
  for (const char c : with_line_ends("\r\n")) wide += {c, '\0'};
  CHECK(read(wide).glasses.at(0).glass == plain.glasses[0].glass);
  CHECK(read(std::string("CC Gl\xE4ser\n") + kTwo).glasses.size() == 2);
}

TEST_CASE("numbers that go on in the next line") {
  const GlassFile file = read(
      "NM A 13 1 1.5 60\nCD 1.25 0.4 0.16\n0.1 0.01 0.0025\n 0.0005 0.0001\n0.00002 0\nTD 1e-6 0 0\n0 0 0 23\nLD 0.45 "
      "0.7\n");
  REQUIRE(file.glasses.size() == 1);
  CHECK(data_of(file.glasses[0]).coefficients.size() == 9);
  CHECK(data_of(file.glasses[0]).reference_temperature_c == 23.0);
  CHECK(refractive_index(file.glasses[0].glass, 500.0) ==
        test::approx(std::sqrt(1.25 + 0.1 + 0.01 + 0.4 + 0.16 + 0.16 + 0.128 + 0.1024 + 0.08192)).epsilon(1e-14));
}

TEST_CASE("a glass that cannot be is left out and named with its line; the others stay") {
  const struct {
    const char* lines;
    const char* words;
  } cases[] = {
      {"NM BAD 2 1 1.5 60\nCD 1 nan 0 0\n", "x.agf:17: glass 'BAD': a coefficient is nan"},
      {"NM BAD 2 1 1.5 60\nCD 1 one 0 0\n", "x.agf:18: 'one' is not a number"},
      {"NM BAD 2 1 1.5 60\nCD 1 2 3 4 5 6 7 8 9 10 11\n", "x.agf:18: more than 10 numbers"},
      {"NM BAD 2 1 1.5 60\nCD 1 0 0 0 0 0 3\n", "7 coefficients"},
      {"NM BAD 14 1 1.5 60\nCD 2\n", "formula 14"},
      {"NM BAD 0.5 1 1.5 60\nCD 2\n", "formula 0.5"},
      {"NM BAD -2147483649 1 1.5 60\nCD 2\n", "formula -2147483649"},
      {"NM BAD 1e300 1 1.5 60\nCD 2\n", "formula 1e+300"},
      {"NM BAD nan 1 1.5 60\nCD 2\n", "formula nan"},
      {"NM BAD x 1 1.5 60\nCD 2\n", "not the number of a formula"},
      {"NM BAD\nCD 2\n", "NM needs"},
      {"NM\nCD 2\n", "NM needs"},
      {"NM BAD 1 1 1.5 60\nLD 0.4 0.7\n", "0 coefficients"},
      {"NM BAD 1 1 1.5 60\nCD -2\nLD 0.4 0.7\n", "index is"},
      {"NM BAD 1 1 1.5 60\nCD 2\nLD 0.7 0.4\n", "range"},
      {"NM BAD 1 1 1.5 60\nCD 2\nLD x 0.4\n", "x.agf:19: LD needs"},
      {"NM BAD 1 1 1.5 60\nCD 2\nIT 0.5 nan 10\n", "x.agf:19: IT has"},
      {"NM BAD 1 1 1.5 60\nCD 2\nIT 0.5 x 10\n", "x.agf:19: IT needs"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.lines);
    const GlassFile file = read(std::string(kTwo) + c.lines);
    CHECK(file.glasses.size() == 2);
    REQUIRE(file.warnings.size() == 1);
    CAPTURE(file.warnings[0]);
    CHECK(file.warnings[0].find(c.words) != std::string::npos);
    CHECK(file.warnings[0].starts_with("x.agf:"));
  }
}

TEST_CASE("stated figures that are no numbers are as if they were not there") {
  const GlassFile file = read("NM A 1 1 nan inf 0 nan\nCD 2.25 -0.01 0.01\nLD 0.4 0.7\n");
  CHECK(std::abs(file.glasses.at(0).summary.n_d - 1.508) < 0.01);
  CHECK(std::isfinite(file.glasses[0].summary.v_d));
  CHECK(file.warnings.empty());
}

TEST_CASE("a thousand broken glasses make a hundred warnings and one more") {
  std::string text = kTwo;
  for (int k = 0; k < 1000; ++k) text += "NM BAD 99\n";
  const GlassFile file = read(text);
  CHECK(file.glasses.size() == 2);
  CHECK(file.warnings.size() == 101);
  CHECK(file.warnings.back().find("more warnings") != std::string::npos);
}

TEST_CASE("a stated index that is another than the formula's is a warning") {
  const GlassFile file = read("NM A 1 1 1.6 60\nCD 2.25\nLD 0.4 0.7\n");
  CHECK(file.glasses.size() == 1);
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0].find("states n_d 1.6") != std::string::npos);
}

void check_refused(const std::string& text, const std::string& words) {
  const auto begin = Clock::now();
  const auto file = read_agf(text, "x.agf", "X");
  CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < kPatience_s);
  REQUIRE_FALSE(file.has_value());
  CAPTURE(file.error().message);
  CHECK(file.error().message.find(words) != std::string::npos);
  CHECK(file.error().message.size() < 1000);
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string out;
  for (std::size_t k = 0; k < times; ++k) out += piece;
  return out;
}

TEST_CASE("files that are no catalogue, or mean harm") {
  check_refused("", "no line begins with NM");
  check_refused("name = \"x\"\n", "no line begins with NM");
  check_refused("NM A 1 1 1.5 60\n", "none of its 1 glasses");
  check_refused(std::string(std::size_t{9} << 20U, 'x'), "at most");
  check_refused(repeated("NM A 99\n", 50'000), "more than 20000");
  check_refused(std::string(7'000'000, ' '), "no line begins with NM");
  check_refused("NM " + std::string(7'000'000, 'a'), "none of its 1");
  check_refused("NM A 1\nCD " + repeated("1 ", 2'000'000), "none of its 1");
}

TEST_CASE("a catalogue cut at each byte") {
  const std::string text = kTwo;
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto file = read_agf(text.substr(0, size), "x.agf", "X");
    if (!file) continue;
    for (const CatalogueEntry& entry : file->glasses) CHECK(refractive_index(entry.glass, 550.0) > 0.0);
  }
}

// Every AGF sample has as many glasses as lines that begin with NM, each near the values that the catalogue states.
TEST_CASE("all catalogues at hand are read whole") {
  const auto folder = shared_data("glass");
  if (!folder) return;
  int files = 0;
  for (const auto& at : std::filesystem::recursive_directory_iterator(*folder)) {
    const std::string extension = at.path().extension().string();
    if (extension != ".agf" && extension != ".AGF") continue;
    CAPTURE(at.path().string());
    ++files;
    std::ifstream stream(at.path(), std::ios::binary);
    std::istringstream lines(decode_text(std::string(std::istreambuf_iterator<char>(stream), {})));
    std::size_t named = 0;
    for (std::string line; std::getline(lines, line);) named += line.starts_with("NM ") ? 1 : 0;
    const auto file = read_glass_file(at.path());
    REQUIRE_MESSAGE(file.has_value(), file.error().to_string());
    CHECK(file->glasses.size() == named);
    // Placeholders with n_d 1, and a glass whose coefficients are missing so far.
    for (const std::string& warning : file->warnings) CHECK(warning.find(" states n_d 1") != std::string::npos);
    CHECK(file->warnings.size() <= 3);
    for (const CatalogueEntry& entry : file->glasses) {
      const auto range = wavelength_range_nm(entry.glass);
      if (entry.summary.n_d == 1.0 || entry.summary.name == "LZ_NEWGLASS" || range->first_nm > kLineF_nm ||
          range->last_nm < kLineC_nm)
        continue;
      CAPTURE(entry.summary.name);
      CHECK(std::abs(refractive_index(entry.glass, kLineD_nm) - entry.summary.n_d) < 2e-4);
    }
  }
  CHECK(files == 22);
}

}  // namespace
}  // namespace contrejour::test::agf
