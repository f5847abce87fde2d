// SPDX-License-Identifier: Apache-2.0
// Each formula against values calculated by hand, published tables, and other programs' fits.
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "contrejour/expert/glass_catalogue.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::formulas {
namespace {

using F = DispersionFormula;

double index_of(F formula, std::vector<double> coefficients, double lambda_nm) {
  GlassData data;
  data.formula = formula;
  data.coefficients = std::move(coefficients);
  return refractive_index({"", CatalogueGlass(std::move(data))}, lambda_nm);
}

struct ByHand {
  F formula;
  std::vector<double> coefficients;
  double n;
};

// At 500 nm, where lambda^2 = 1/4 um^2: each term with its power's value.
const ByHand kByHand[] = {
    {F::Schott,
     {1.25, 0.4, 0.1, 0.01, 0.0025, 0.0005},
     std::sqrt(1.25 + 0.4 / 4 + 0.1 * 4 + 0.01 * 16 + 0.0025 * 64 + 0.0005 * 256)},
    // 0.25 / (0.25 - 0.05) = 5/4, 0.25 / (0.25 + 0.75) = 1/4, 0.25 / (0.25 - 0.5) = -1, ...
    {F::Sellmeier1, {0.8, 0.05, 0.4, -0.75, -0.2, 0.5}, std::sqrt(1 + 1.0 + 0.1 + 0.2)},
    {F::Herzberger,
     {1.4, 0.01, 0.002, -0.03, 0.04, 0.05},
     1.4 + 0.01 / 0.222 + 0.002 / (0.222 * 0.222) - 0.03 / 4 + 0.04 / 16 + 0.05 / 64},
    // 0.25 / (0.25 - 0.4^2) = 25/9; 1 / (0.25 - 10^2)
    {F::Sellmeier2, {0.3, 0.36, 0.4, -1.0, 10.0}, std::sqrt(1 + 0.3 + 1.0 + 1.0 / 99.75)},
    {F::Conrady, {1.45, 0.0125, 0.0002}, 1.45 + 0.025 + 0.0002 * 8 * std::sqrt(2.0)},
    {F::Sellmeier3, {0.8, 0.05, 0.4, -0.75, -0.2, 0.5, 0.04, 0.125}, std::sqrt(1 + 1.0 + 0.1 + 0.2 + 0.08)},
    {F::HandbookOfOptics1, {2.2, 0.02, 0.05, 0.04}, std::sqrt(2.2 + 0.1 - 0.01)},
    {F::HandbookOfOptics2, {1.2, 0.8, 0.05, 0.04}, std::sqrt(1.2 + 1.0 - 0.01)},
    {F::Sellmeier4, {1.1, 0.8, 0.05, 0.4, -0.75}, std::sqrt(1.1 + 1.0 + 0.1)},
    {F::Extended1,
     {1.25, 0.4, 0.1, 0.01, 0.0025, 0.0005, 0.0001, 0.00002},
     std::sqrt(1.25 + 0.1 + 0.4 + 0.16 + 0.16 + 0.128 + 0.0001 * 1024 + 0.00002 * 4096)},
    {F::Sellmeier5,
     {0.8, 0.05, 0.4, -0.75, -0.2, 0.5, 0.04, 0.125, 0.1, 0.225},
     std::sqrt(1 + 1.0 + 0.1 + 0.2 + 0.08 + 1.0)},
    {F::Extended2,
     {1.25, 0.4, 0.1, 0.01, 0.0025, 0.0005, 0.16, 0.64},
     std::sqrt(1.25 + 0.1 + 0.4 + 0.16 + 0.16 + 0.128 + 0.16 / 16 + 0.64 / 64)},
    {F::Extended3,
     {1.25, 0.4, 0.16, 0.1, 0.01, 0.0025, 0.0005, 0.0001, 0.00002},
     std::sqrt(1.25 + 0.1 + 0.01 + 0.4 + 0.16 + 0.16 + 0.128 + 0.1024 + 0.08192)},
    {F::Rii1, {0.1, 0.84, 0.2, 0.09, 0.4}, std::sqrt(1 + 0.1 + 0.84 * 25 / 21 + 0.25)},
    {F::Rii2, {0.1, 0.8, 0.05, 0.4, -0.75}, std::sqrt(1 + 0.1 + 1.0 + 0.1)},
    {F::Rii3, {1.25, 0.4, 2, 0.1, -2, 0.01, -4, 0.05, 1}, std::sqrt(1.25 + 0.1 + 0.4 + 0.16 + 0.025)},
    // 0.3 l^2 / (l^2 - 0.2^2) + 0.4 l^0 / (l^2 - 0.05^1), then powers
    {F::Rii4,
     {1.5, 0.42, 2, 0.2, 2, 0.04, 0, 0.05, 1, 0.4, 2, 0.1, -2},
     std::sqrt(1.5 + 0.42 * 25 / 21 + 0.2 + 0.1 + 0.4)},
    {F::Rii5, {1.4, 0.01, -2, 0.002, -4}, 1.4 + 0.04 + 0.032},
    {F::Rii6, {0.001, 0.06, 64, 0.0014, 11}, 1.001 + 0.001 + 0.0002},
    {F::Rii7,
     {1.4, 0.01, 0.002, -0.03, 0.04, 0.05},
     1.4 + 0.01 / 0.222 + 0.002 / (0.222 * 0.222) - 0.03 / 4 + 0.04 / 16 + 0.05 / 64},
    // (n^2 - 1) / (n^2 + 2) = 1/4 where n^2 = 2
    {F::Rii8, {0.1, 0.08, 0.05, 0.2}, std::sqrt(2.0)},
    {F::Rii9, {2.0, 0.05, 0.05, 0.1, 0.4, 0.04}, std::sqrt(2.0 + 0.25 + 0.1 * 0.1 / 0.05)},
    {F::Cauchy, {1.4, 0.01, 0.002, 0.0001}, 1.4 + 0.04 + 0.032 + 0.0064},
    // d = 0.5 - 0.58, w = d / (1 + 2.5 d) = -0.1
    {F::Buchdahl, {0.58, 1.5, -0.04, -0.004}, 1.5 + 0.004 - 0.00004},
    {F::Table, {0.4, 1.6, 0.5, 1.58, 0.6, 1.57}, 1.58},
};

TEST_CASE("every formula at 500 nm by hand") {
  CHECK(std::size(kByHand) == all_formulas().size());
  for (const ByHand& c : kByHand) {
    CAPTURE(formula_name(c.formula));
    CHECK(index_of(c.formula, c.coefficients, 500.0) == test::approx(c.n).epsilon(1e-14));
    CHECK(formula_of_name(formula_name(c.formula)) == c.formula);
  }
}

// SCHOTT's data sheet of N-BK7 (2017), refractive indices, printed to five decimals.
TEST_CASE("N-BK7 as its data sheet prints it") {
  const std::vector<double> bk7{1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653};
  const struct {
    double nm, n;
  } sheet[] = {{1013.98, 1.50731},        {852.11, 1.50980},    {kLineR_nm, 1.51289}, {kLineC_nm, 1.51432},
               {kLineCPrime_nm, 1.51472}, {kLineD_nm, 1.51680}, {kLineE_nm, 1.51872}, {kLineF_nm, 1.52238},
               {kLineFPrime_nm, 1.52283}, {kLineG_nm, 1.52668}, {kLineH_nm, 1.53024}, {kLineI_nm, 1.53627}};
  for (const auto& [nm, n] : sheet) {
    CAPTURE(nm);
    CHECK(std::abs(index_of(F::Sellmeier1, bk7, nm) - n) <= 0.6e-5);
  }
  // The lens format's own three terms are the same formula.
  const Glass three{"", Sellmeier{{bk7[0], bk7[2], bk7[4]}, {bk7[1], bk7[3], bk7[5]}}};
  CHECK(refractive_index(three, 480.0) == test::approx(index_of(F::Sellmeier1, bk7, 480.0)).epsilon(1e-15));
}

TEST_CASE("coefficients left out at the end are 0") {
  CHECK(index_of(F::Extended1, {2.25}, 500.0) == 1.5);
  CHECK(index_of(F::Sellmeier5, {0.8, 0.05}, 500.0) == test::approx(std::sqrt(2.0)).epsilon(1e-15));
  CHECK(index_of(F::Sellmeier2, {1.25}, 500.0) == 1.5);
  CHECK(index_of(F::Extended2, {1.25, 0.4, 0.1}, 500.0) == index_of(F::Schott, {1.25, 0.4, 0.1}, 500.0));
}

// Robb & Mercado 1983, tables of coefficients fitted to Schott's glasses of that time, with the largest error over 400
// to 700 nm that they found: Buchdahl's coordinate, its constant and its zero are theirs.
TEST_CASE("Buchdahl coefficients published for Schott's glasses give the glasses") {
  const auto path = shared_data("glass/opticalglass/robb1983_data_final.txt");
  if (!path) return;
  const GlassCatalogue catalogue = bundled_glasses();
  const std::string schott[] = {"SCHOTT"};
  std::ifstream file(*path);
  std::string line;
  int compared = 0, close = 0;
  while (std::getline(file, line)) {
    if (line.find("HOYA") != std::string::npos || line.find("OHARA") != std::string::npos) break;
    std::istringstream words(line);
    std::string name;
    double n = 0, nu1 = 0, nu2 = 0, deviation = 0, max = 0;
    if (!(words >> name >> n >> nu1 >> nu2 >> deviation >> max)) continue;
    const auto found = catalogue.find(name, schott);
    if (!found || found->summary.name != name) continue;
    double worst = 0;
    for (double nm = 400; nm <= 700; nm += 20)
      worst = std::max(worst,
                       std::abs(refractive_index(found->glass, nm) - index_of(F::Buchdahl, {0.574, n, nu1, nu2}, nm)));
    ++compared;
    // The catalogue's formulas have been refitted since: some glasses changed by a few 1e-5, and a few rows are
    // misprinted.
    if (worst < max + 3e-5) ++close;
  }
  MESSAGE(fmt::format("{} of {} within 3e-5 of the published error", close, compared));
  CHECK(compared > 60);
  CHECK(close > 0.8 * compared);
}

}  // namespace
}  // namespace contrejour::test::formulas
