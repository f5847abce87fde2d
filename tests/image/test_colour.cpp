// SPDX-License-Identifier: Apache-2.0
// Oracles: CIE 15:2018 (chromaticities, tables), ITU-R BT.709, the published ACEScg to Rec.709 matrix.
#include <cmath>
#include <fstream>
#include <sstream>

#include "contrejour/expert/colour.h"
#include "shared_data.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

void check_xy(const Spectrum& spectrum, double x, double y, double tolerance) {
  const auto xy = chromaticity(xyz_of(spectrum));
  CHECK(std::abs(xy[0] - x) < tolerance);
  CHECK(std::abs(xy[1] - y) < tolerance);
}

std::vector<std::vector<double>> rows_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // headings
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

}  // namespace

TEST_CASE("chromaticities of the standard illuminants are the CIE's") {
  check_xy(IlluminantD65{}, 0.31272, 0.32903, 1e-4);  // CIE 15:2018 table T.3
  check_xy(IlluminantA{}, 0.44758, 0.40745, 1e-4);
  check_xy(EqualEnergy{}, 1.0 / 3, 1.0 / 3, 1e-4);
  check_xy(BlackBody{2856}, 0.44758, 0.40745, 1e-4);  // what A stands for
  check_xy(BlackBody{6500}, 0.3135, 0.3237, 2e-4);    // Wyszecki & Stiles 1982, table 1(3.11.2)
}

TEST_CASE("spectral power is 1 at 560 nm and the embedded tables are the CIE's") {
  for (const Spectrum& s :
       {Spectrum(IlluminantD65{}), Spectrum(IlluminantA{}), Spectrum(BlackBody{500}), Spectrum(BlackBody{100000})})
    CHECK(spectral_power(s, 560) == test::approx(1).epsilon(1e-12));
  CHECK(spectral_power(IlluminantD65{}, 299) == 0);
  CHECK(spectral_power(IlluminantD65{}, 831) == 0);
  CHECK(colour_matching(359)[1] == 0);
  CHECK(colour_matching(831)[1] == 0);

  if (const auto file = test::shared_data("colour/cie/CIE_xyz_1931_2deg.csv"))
    for (const auto& row : rows_of(*file))
      for (std::size_t c = 0; c < 3; ++c) CHECK(colour_matching(row[0])[c] == test::approx(row[c + 1]).epsilon(1e-9));
  if (const auto file = test::shared_data("colour/cie/CIE_std_illum_D65.csv"))
    for (const auto& row : rows_of(*file))
      CHECK(std::abs(100 * spectral_power(IlluminantD65{}, row[0]) - row[1]) < 6e-4);  // its rounding
  if (const auto file = test::shared_data("colour/cie/CIE_std_illum_A_1nm.csv"))
    for (const auto& row : rows_of(*file)) CHECK(std::abs(100 * spectral_power(IlluminantA{}, row[0]) - row[1]) < 6e-4);
}

TEST_CASE("D65 is white in both spaces and conversion goes both ways") {
  for (const ColourSpace space : {ColourSpace::Rec709, ColourSpace::AcesCg}) {
    const Rgb white = rgb_of(IlluminantD65{}, space);
    for (const double value : white) CHECK(value == test::approx(1).epsilon(1e-12));
    const Rgb rgb{0.2, 0.7, 1.9};
    const Rgb back = rgb_from_xyz(xyz_from_rgb(rgb, space), space);
    for (std::size_t c = 0; c < 3; ++c) CHECK(back[c] == test::approx(rgb[c]).epsilon(1e-12));
    CHECK(luminance(rgb_of(BlackBody{2000}, space), space) == test::approx(1).epsilon(1e-12));
  }
}

TEST_CASE("the matrices are the published ones") {
  // IEC 61966-2-1 gives four digits for a white of (0.3127, 0.3290); the tabulated D65 moves them by less than 5e-4.
  constexpr double kXyzFrom709[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
  // ACES AP1 to Rec.709 by Bradford, as colour-science and OpenColorIO's ACES configuration print it.
  constexpr double k709FromAcesCg[3][3] = {
      {1.70505, -0.62179, -0.08326}, {-0.13026, 1.14080, -0.01055}, {-0.02400, -0.12897, 1.15297}};
  for (std::size_t c = 0; c < 3; ++c) {
    Rgb unit{};
    unit[c] = 1;
    const Xyz xyz = xyz_from_rgb(unit, ColourSpace::Rec709);
    const Rgb from_aces = rgb_from_xyz(xyz_from_rgb(unit, ColourSpace::AcesCg), ColourSpace::Rec709);
    for (std::size_t r = 0; r < 3; ++r) {
      CHECK(std::abs(xyz[r] - kXyzFrom709[r][c]) < 5e-4);
      CHECK(std::abs(from_aces[r] - k709FromAcesCg[r][c]) < 5e-4);
    }
  }
}

TEST_CASE("spectra by name") {
  CHECK(std::holds_alternative<IlluminantD65>(parse_spectrum("D65").value()));
  CHECK(std::holds_alternative<IlluminantA>(parse_spectrum("A").value()));
  CHECK(std::holds_alternative<EqualEnergy>(parse_spectrum("E").value()));
  CHECK(std::get<BlackBody>(parse_spectrum("3200K").value()).temperature_k == 3200);
  for (const char* wrong : {"", "K", "D50", "3200", "3200KK", "-5K", "nanK", "infK", "1e9K", "499K"}) {
    CAPTURE(wrong);
    CHECK_FALSE(parse_spectrum(wrong).has_value());
  }
}
