// SPDX-License-Identifier: Apache-2.0
// Tables, model glasses, codes, air, temperature, transmittance; refused input.
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "contrejour/expert/glass_catalogue.h"
#include "support/approx.h"

namespace contrejour::test::values {
namespace {

using F = DispersionFormula;

const std::vector<double> kBk7{1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653};

GlassData bk7_data() {
  GlassData data;
  data.formula = F::Sellmeier1;
  data.coefficients = kBk7;
  data.range_nm = WavelengthRange{300.0, 2500.0};
  data.thermal = ThermalDispersion{1.86e-6, 1.31e-8, -1.37e-11, 4.34e-7, 6.27e-10, 0.17};
  return data;
}

Glass bk7() { return {"N-BK7", CatalogueGlass(bk7_data())}; }

Glass table(std::vector<double> points) {
  GlassData data;
  data.formula = F::Table;
  data.coefficients = std::move(points);
  return {"", CatalogueGlass(std::move(data))};
}

TEST_CASE("a table passes through its points, never beyond its neighbours, and keeps its ends") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(0.005, 0.1), index(1.3, 2.0);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> points;
    double um = 0.3;
    for (int k = 0; k < 2 + trial % 9; ++k) points.insert(points.end(), {um += step(random), index(random)});
    const Glass glass = table(points);
    for (std::size_t k = 0; k < points.size(); k += 2)
      CHECK(refractive_index(glass, points[k] * 1e3) == test::approx(points[k + 1]).epsilon(1e-11));
    for (std::size_t k = 0; k + 2 < points.size(); k += 2) {
      const double low = std::min(points[k + 1], points[k + 3]), high = std::max(points[k + 1], points[k + 3]);
      for (int i = 1; i < 20; ++i) {
        const double n = refractive_index(glass, 1e3 * std::lerp(points[k], points[k + 2], i / 20.0));
        CHECK(n >= low - 1e-14);
        CHECK(n <= high + 1e-14);
      }
    }
    CHECK(refractive_index(glass, 1.0) == points[1]);
    CHECK(refractive_index(glass, 1e6) == points.back());
  }
  CHECK(refractive_index(table({0.5, 1.7}), 333.0) == 1.7);
}

TEST_CASE("a table of a smooth glass is the glass") {
  std::vector<double> points;
  for (double um = 0.36; um < 0.81; um += 0.02) points.insert(points.end(), {um, refractive_index(bk7(), um * 1e3)});
  for (double nm = 380; nm < 780; nm += 3.7)
    CHECK(std::abs(refractive_index(table(points), nm) - refractive_index(bk7(), nm)) < 2e-5);
}

TEST_CASE("a model glass has the figures it was given") {
  for (const ModelGlass& model :
       {ModelGlass{1.5168, 64.17, -0.0009}, ModelGlass{1.80518, 25.36, 0.0092}, ModelGlass{1.497, 81.54, 0.03}}) {
    const GlassFigures figures = glass_figures({"", model});
    CHECK(figures.n_d == test::approx(model.n_d).epsilon(1e-14));
    CHECK(figures.v_d == test::approx(model.v_d).epsilon(1e-10));
    CHECK(figures.d_pgf == test::approx(model.d_pgf).epsilon(1e-8));
  }
  CHECK(refractive_index({"", ModelGlass{1.6, 0.0, 0.0}}, 400.0) == 1.6);
}

TEST_CASE("model glasses against the catalogues they stand for, 400 to 700 nm") {
  const GlassCatalogue catalogue = bundled_glasses();
  std::vector<double> errors;
  for (std::size_t k = 0; k < catalogue.size(); ++k) {
    const GlassSummary summary = catalogue.summary(k);
    if (summary.status == GlassStatus::Obsolete || summary.maker == "MISC" || summary.maker == "CDGM") continue;
    const Glass glass = catalogue.entry(k).glass;
    const auto range = wavelength_range_nm(glass);
    if (range->first_nm > 400 || range->last_nm < 700) continue;
    const GlassFigures figures = glass_figures(glass);
    const Glass model{"", ModelGlass{figures.n_d, figures.v_d, figures.d_pgf}};
    double worst = 0;
    for (double nm = 400; nm <= 700; nm += 10)
      worst = std::max(worst, std::abs(refractive_index(glass, nm) - refractive_index(model, nm)));
    errors.push_back(worst);
  }
  std::sort(errors.begin(), errors.end());
  MESSAGE(errors.size(), " glasses: median ", errors[errors.size() / 2], ", 95 % ", errors[errors.size() * 95 / 100],
          ", worst ", errors.back());
  CHECK(errors[errors.size() / 2] < 7e-5);
  CHECK(errors[errors.size() * 95 / 100] < 1.5e-4);
}

TEST_CASE("six-digit codes") {
  const auto glass = glass_of_code("517642");
  REQUIRE(glass.has_value());
  CHECK(glass->name == "517642");
  const auto& model = std::get<ModelGlass>(glass->dispersion);
  CHECK(model.n_d == 1.517);
  CHECK(model.v_d == 64.2);
  CHECK(model.d_pgf == 0.0);
  CHECK(std::abs(glass_figures(*glass).p_gf - (0.6438 - 0.001682 * 64.2)) < 1e-12);
  CHECK(glass_of_code("620364.360").has_value());
  for (const char* text :
       {"", "51764", "5176422", "517642.", "517642.2510", "51764a", "-17642", "517.642", "000642", "517000", " 517642"})
    CHECK_FALSE(glass_of_code(text).has_value());
}

// Edlen 1966 at 15 deg C, an independent measurement with another formula: (n - 1) 1e8 = 8342.13 + 2406030 / (130 - s)
// + 15997 / (38.9 - s) with s = 1 / lambda^2, um. The two agree to about 1e-8.
TEST_CASE("air") {
  for (double nm = 380; nm <= 1000; nm += 20) {
    const double s = 1e6 / (nm * nm);
    const double edlen = 1.0 + 1e-8 * (8342.13 + 2406030 / (130 - s) + 15997 / (38.9 - s));
    CHECK(std::abs(air_index(nm, {15.0, 1.0}) - edlen) < 3e-8);
  }
  CHECK(air_index(550, {20.0, 0.0}) == 1.0);
  CHECK(air_index(550, {15.0, 0.5}) - 1.0 == test::approx(0.5 * (air_index(550, {15.0, 1.0}) - 1.0)));
  // Hotter air has lower density, as an ideal gas: 288.15 K over 338.15 K to 0.1 %.
  CHECK((air_index(550, {65.0, 1.0}) - 1) / (air_index(550, {15.0, 1.0}) - 1) ==
        test::approx(288.15 / 338.15).epsilon(1e-3));
}

TEST_CASE("at the catalogue's conditions n is the catalogue's, to the last bit") {
  for (double nm = 350; nm < 1000; nm += 13)
    CHECK(refractive_index(bk7(), nm, {20.0, 1.0}) == refractive_index(bk7(), nm));
  const Glass sellmeier{"",
                        Sellmeier{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}};
  CHECK(refractive_index(sellmeier, 500, {20.0, 1.0}) == refractive_index(sellmeier, 500));
  CHECK(refractive_index(air(), 500, {90.0, 0.3}) == 1.0);
}

// SCHOTT's data sheet of N-BK7, temperature coefficients at the e line in 1e-6 / K: dn_rel/dT 2.9 from -40 to -20 deg
// C, 3.0 from 20 to 40, 3.1 from 60 to 80; dn_abs/dT 0.8, 1.6, 2.1. Printed to 0.1.
TEST_CASE("temperature coefficients of N-BK7 as its data sheet prints them") {
  const struct {
    double from_c, to_c, relative, absolute;
  } sheet[] = {{-40, -20, 2.9, 0.8}, {20, 40, 3.0, 1.6}, {60, 80, 3.1, 2.1}};
  for (const auto& s : sheet) {
    const auto per_k = [&](auto n) { return (n(s.to_c) - n(s.from_c)) / (s.to_c - s.from_c) * 1e6; };
    const double nm = kLineE_nm;
    CAPTURE(s.from_c);
    CHECK(std::abs(per_k([&](double c) { return refractive_index(bk7(), nm, {c, 1.0}); }) - s.relative) < 0.1);
    const auto absolute = [&](double c) { return refractive_index(bk7(), nm, {c, 1.0}) * air_index(nm, {c, 1.0}); };
    CHECK(std::abs(per_k(absolute) - s.absolute) < 0.1);
  }
}

TEST_CASE("in vacuum a glass keeps its absolute index") {
  GlassData data = bk7_data();
  const double n_air = air_index(500.0);
  // The same light: 500 nm in air are 500 n nm in vacuum.
  CHECK(refractive_index(bk7(), 500.0 * n_air, {20.0, 0.0}) ==
        test::approx(refractive_index(bk7(), 500.0) * n_air).epsilon(2e-8));
  data.index_in_vacuum = true;
  CHECK(refractive_index({"", CatalogueGlass(data)}, 500.0) ==
        test::approx(refractive_index(bk7(), 500.0) / n_air).epsilon(1e-15));
  data.wavelength_in_vacuum = true;
  CHECK(refractive_index({"", CatalogueGlass(data)}, 500.0) ==
        test::approx(refractive_index(bk7(), 500.0 * n_air) / n_air).epsilon(1e-15));
}

TEST_CASE("a negative lambda_tk stands for a sum") {
  GlassData data = bk7_data();
  data.thermal = ThermalDispersion{0, 0, 0, 1e-6, 0, -0.2};
  const double n = refractive_index(bk7(), 500.0);
  const double change = 1e-6 * 30 / (0.25 + 0.04) * (n * n - 1) / (2 * n);
  const double hot_nm = 500.0 * air_index(500.0) / air_index(500.0, {50.0, 1.0});
  const double hot = refractive_index({"", CatalogueGlass(data)}, hot_nm, {50.0, 1.0}) * air_index(hot_nm, {50.0, 1.0});
  CHECK(hot - n * air_index(500.0) == test::approx(change).epsilon(1e-3));
}

TEST_CASE("transmittance: through the measured points, by Beer's law in length") {
  GlassData data = bk7_data();
  const double per_mm = -std::log(0.9) / 25.0;
  data.absorption = {{400.0, per_mm}, {500.0, 3 * per_mm}};
  const Glass glass{"", CatalogueGlass(data)};
  CHECK(internal_transmittance(glass, 400.0, 25.0) == test::approx(0.9).epsilon(1e-14));
  CHECK(internal_transmittance(glass, 400.0, 50.0) == test::approx(0.81).epsilon(1e-14));
  CHECK(internal_transmittance(glass, 450.0, 25.0) == test::approx(0.81).epsilon(1e-14));  // twice the coefficient
  CHECK(internal_transmittance(glass, 300.0, 25.0) == test::approx(0.9).epsilon(1e-14));
  CHECK(internal_transmittance(glass, 900.0, 25.0) == test::approx(0.729).epsilon(1e-14));
  CHECK(internal_transmittance(glass, 450.0, 0.0) == 1.0);
  CHECK(internal_transmittance(bk7(), 450.0, 25.0) == 1.0);
  CHECK(internal_transmittance(air(), 450.0, 1e9) == 1.0);
}

TEST_CASE("ranges are kept") {
  CHECK(wavelength_range_nm(bk7()) == WavelengthRange{300.0, 2500.0});
  CHECK_FALSE(wavelength_range_nm(air()).has_value());
  GlassData data;
  data.formula = F::Table;
  data.coefficients = {0.4, 1.6, 0.7, 1.5};
  CHECK(wavelength_range_nm(*make_glass("t", data)) == WavelengthRange{400.0, 700.0});
}

TEST_CASE("two glasses are the same by what they hold") {
  CHECK(bk7() == bk7());
  GlassData other = bk7_data();
  other.coefficients[2] += 1e-9;
  CHECK_FALSE(bk7() == Glass{"N-BK7", CatalogueGlass(other)});
}

void check_refused(const GlassData& data, const std::string& words) {
  const auto glass = make_glass("bad", data);
  CAPTURE(words);
  REQUIRE_FALSE(glass.has_value());
  CAPTURE(glass.error().message);
  CHECK(glass.error().message.find(words) != std::string::npos);
  CHECK(glass.error().message.find("bad") != std::string::npos);
}

TEST_CASE("what is no glass") {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  CHECK(make_glass("good", bk7_data()).has_value());
  const auto with = [](auto change) {
    GlassData data = bk7_data();
    change(data);
    return data;
  };
  check_refused(with([&](GlassData& d) { d.coefficients[3] = kNaN; }), "coefficient is nan");
  check_refused(with([&](GlassData& d) { d.coefficients[3] = kInf; }), "coefficient is inf");
  check_refused(with([&](GlassData& d) { d.coefficients.clear(); }), "0 coefficients");
  check_refused(with([&](GlassData& d) { d.coefficients.resize(7); }), "7 coefficients");
  check_refused(with([&](GlassData& d) { d.coefficients[0] = -30; }), "index is");
  check_refused(with([&](GlassData& d) { d.range_nm = WavelengthRange{700, 400}; }), "range");
  check_refused(with([&](GlassData& d) { d.range_nm = WavelengthRange{kNaN, 400}; }), "range");
  check_refused(with([&](GlassData& d) { d.range_nm = WavelengthRange{0, 400}; }), "range");
  check_refused(with([&](GlassData& d) { d.thermal->d1 = kNaN; }), "thermal");
  check_refused(with([&](GlassData& d) { d.reference_temperature_c = -300; }), "temperature");
  check_refused(with([&](GlassData& d) { d.absorption = {{500, 0.1}, {500, 0.2}}; }), "rise");
  check_refused(with([&](GlassData& d) { d.absorption = {{500, -0.1}}; }), "absorption");
  check_refused(with([&](GlassData& d) { d.formula = static_cast<F>(17); }), "not known");
  check_refused(with([&](GlassData& d) { d.formula = F::Rii2; }), "odd number");
  GlassData points;
  points.formula = F::Table;
  points.coefficients = {0.4, 1.5, 0.4, 1.6};
  check_refused(points, "rise");
  points.coefficients = {0.4, 1.5, 0.5};
  check_refused(points, "pairs");
  points.coefficients = {0.4, 1.5, 0.5, -1.6};
  check_refused(points, "index is");
}

}  // namespace
}  // namespace contrejour::test::values
