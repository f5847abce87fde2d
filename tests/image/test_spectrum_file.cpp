// SPDX-License-Identifier: Apache-2.0
// Spectra as tables: files, the bundled lamps against the CIE's figures, narrow lines.
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "contrejour/expert/spectrum_file.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

TabulatedSpectrum read(const std::string& text) {
  const auto spectrum = read_spectrum(text, "lamp.csv");
  REQUIRE_MESSAGE(spectrum.has_value(), (spectrum ? "" : spectrum.error().to_string()));
  return *spectrum;
}

std::string error_of(const std::string& text) {
  const auto spectrum = read_spectrum(text, "lamp.csv");
  REQUIRE_FALSE(spectrum.has_value());
  CHECK(spectrum.error().code == ErrorCode::Parse);
  return spectrum.error().to_string();
}

void check_xy(const char* name, double x, double y, double tolerance) {
  CAPTURE(name);
  const auto spectrum = find_spectrum(name);
  REQUIRE(spectrum.has_value());
  const auto xy = chromaticity(xyz_of(*spectrum));
  CHECK(std::abs(xy[0] - x) < tolerance);
  CHECK(std::abs(xy[1] - y) < tolerance);
}

}  // namespace

TEST_CASE("what a spectrum file may look like") {
  const std::vector<SpectrumPoint> expected{{400, 1}, {500.5, 0.25}, {700, 0}};
  for (const char* text :
       {"400,1\n500.5,0.25\n700,0\n", "400 1\n500.5\t0.25\n700   0", "400;1\r\n500.5 ; 2.5e-1\r\n\r\n700, 0\r\n",
        "# a lamp\nwavelength [nm], power\n400,1 # first\n\n500.5,.25\n  700 , 0  \n",
        "\xEF\xBB\xBFnm power\n400 1\n500.5 0.25\n700 0"}) {
    CAPTURE(text);
    CHECK(*read(text).points == expected);
  }
  CHECK(*read(write_spectrum(read("400,1\n500.1234567890123,0.1\n"))).points ==
        std::vector<SpectrumPoint>{{400, 1}, {500.1234567890123, 0.1}});
}

TEST_CASE("what is wrong with a spectrum file is said with its line") {
  CHECK(error_of("400,1\n500 nm,2\n").find("lamp.csv:2: ") == 0);
  CHECK(error_of("400,1\n300,2\n").find("lamp.csv:2: 300 nm comes after 400 nm") == 0);
  CHECK(error_of("400,1\n400,2\n").find("lamp.csv:2: ") == 0);
  CHECK(error_of("400,1\n500,-2\n").find("lamp.csv:2: a power of -2") == 0);
  CHECK(error_of("-400,1\n500,2\n").find("lamp.csv:1: ") == 0);
  CHECK(error_of("a\nb\n400,1\n500,1\n").find("lamp.csv:2: ") == 0);
  for (const char* text :
       {"", "400,1\n", "#\n", "400,1,2\n500,1\n", "400\n500\n", "400,,1\n500,1", "400,nan\n500,1", "400,inf\n500,1",
        "nan,1\n500,1", "4001\n5001", "1000,1\n1100,1\n", "400,0\n500,0\n", "400,1\n1e99,1\n", "400,1e99\n500,1\n"}) {
    CAPTURE(text);
    CHECK(!error_of(text).empty());
  }
  CHECK(read_spectrum(std::string(2 << 20, ' '), "big").error().message.find("larger") == 0);
  CHECK(find_spectrum("./no-such-lamp.csv").error().code == ErrorCode::Io);
  CHECK(find_spectrum("no-such-lamp").error().code == ErrorCode::InvalidArgument);
  CHECK(std::holds_alternative<BlackBody>(find_spectrum("3200.5K").value()));
}

TEST_CASE("the bundled lamps have the colours that the CIE gives them") {
  check_xy("fluorescent", 0.3721, 0.3751, 3e-4);  // CIE 15:2018 table 10.1: FL2, FL11
  check_xy("fluorescent-narrow", 0.3805, 0.3769, 6e-4);
  check_xy("sodium", 0.533, 0.415, 1.5e-3);  // HP1, whose lines are separated by 5 nm steps with linear interpolation
  check_xy("led", 0.3756, 0.3723, 2e-4);  // LED-B3
  // Two adjacent lines lie on the spectral locus.
  const auto at_589 = chromaticity(colour_matching(589.3));
  check_xy("sodium-low", at_589[0], at_589[1], 2e-4);
  CHECK(bundled_spectra().size() == 5);
  for (const BundledSpectrum& lamp : bundled_spectra()) CHECK(find_spectrum(std::string(lamp.name)).has_value());
}

TEST_CASE("a line keeps its power and position wherever it falls between whole nanometres") {
  for (const double line_nm : {550.0, 550.2, 550.5, 550.98}) {
    CAPTURE(line_nm);
    const Spectrum spectrum =
        read(write_spectrum(read(std::to_string(line_nm - 0.01) + ",0\n" + std::to_string(line_nm) + ",100\n" +
                                 std::to_string(line_nm + 0.01) + ",0\n")));
    double power = 0.0, moment = 0.0;
    for (int nm = 360; nm <= 830; ++nm) {
      power += spectral_power_near(spectrum, nm);
      moment += nm * spectral_power_near(spectrum, nm);
    }
    CHECK(power == test::approx(1.0).epsilon(1e-6));  // 0.02 nm at 50 in the mean
    CHECK(moment / power == test::approx(line_nm).epsilon(1e-8));
  }
}

TEST_CASE("a table of a smooth spectrum is that spectrum") {
  std::string text;
  for (int nm = 360; nm <= 830; ++nm)
    text += std::to_string(nm) + "," + std::to_string(spectral_power(IlluminantA{}, nm)) + "\n";
  const Spectrum table = read(text);
  for (const ColourSpace space : {ColourSpace::Rec709, ColourSpace::AcesCg}) {
    const auto expected = spectral_bands(7, IlluminantA{}, space);
    const auto bands = spectral_bands(7, table, space);
    for (std::size_t k = 0; k < bands.size(); ++k) {
      CHECK(bands[k].lambda_nm == test::approx(expected[k].lambda_nm).epsilon(1e-4));
      for (std::size_t c = 0; c < 3; ++c)
        CHECK(bands[k].weight[c] == test::approx(expected[k].weight[c]).epsilon(1e-2));
    }
  }
}

TEST_CASE("bands stand where a lamp has its light, and every channel's weights sum to 1") {
  for (const BundledSpectrum& lamp : bundled_spectra()) {
    const std::string name(lamp.name);
    CAPTURE(name);
    const Spectrum spectrum = find_spectrum(name).value();
    for (const ColourSpace space : {ColourSpace::Rec709, ColourSpace::AcesCg}) {
      for (const int count : {1, 3, 16, 300}) {
        CAPTURE(count);
        double last_nm = 0.0;
        Rgb sum{};
        for (const SpectralBand& band : spectral_bands(count, spectrum, space)) {
          CHECK(band.lambda_nm > last_nm);
          last_nm = band.lambda_nm;
          if (name == "sodium-low") CHECK(std::abs(band.lambda_nm - 589.29) < 1.5);
          for (std::size_t c = 0; c < 3; ++c) {
            CHECK(std::abs(band.weight[c]) < 5);
            sum[c] += band.weight[c];
          }
        }
        for (const double total : sum) CHECK(total == 1.0);
      }
    }
  }
}
