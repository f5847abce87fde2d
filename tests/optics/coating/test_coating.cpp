// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "contrejour/expert/coating.h"
#include "shared_data.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

std::complex<double> complex_of(const nlohmann::json& pair) { return {pair[0], pair[1]}; }

void check_close(std::complex<double> value, const nlohmann::json& expected, double tolerance) {
  CHECK(std::abs(value - complex_of(expected)) <= tolerance);
}

double unpolarised(const FilmResponse& r) { return 0.5 * (r.R_s + r.R_p); }

}  // namespace

TEST_CASE("amplitudes and powers of absorbing films agree with tmm's published test values") {
  const auto oracle = test::shared_data("oracles/tmm_expected.json");
  if (!oracle) return;
  std::ifstream in(*oracle);
  const auto t = nlohmann::json::parse(in)["basic_test"];
  const FilmLayer films[] = {{complex_of(t["n"][1]), t["d"][1]}, {complex_of(t["n"][2]), t["d"][2]}};
  const FilmResponse r =
      film_response(complex_of(t["n"][0]), films, complex_of(t["n"][3]), t["theta0_rad"], t["lambda"]);
  check_close(r.r_s, t["s"]["r"], 1e-9);
  check_close(r.t_s, t["s"]["t"], 1e-9);
  check_close(r.r_p, t["p"]["r"], 1e-9);
  check_close(r.t_p, t["p"]["t"], 1e-9);
  CHECK(std::abs(r.R_s - t["s"]["R"].get<double>()) < 1e-9);
  CHECK(std::abs(r.T_s - t["s"]["T"].get<double>()) < 1e-9);
  CHECK(std::abs(r.R_p - t["p"]["R"].get<double>()) < 1e-9);
  CHECK(std::abs(r.T_p - t["p"]["T"].get<double>()) < 1e-9);
}

TEST_CASE("lossless stacks keep all light: R + T = 1 to 1e-12 at any angle") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> index(1.2, 2.6), thickness(0.0, 900.0), lambda(360.0, 830.0), unit(0.0, 1.0);
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<FilmLayer> films(static_cast<std::size_t>(trial % 12));
    for (FilmLayer& film : films) film = {index(random), thickness(random)};
    const double n_in = trial % 2 == 0 ? 1.0 : index(random);
    const double n_out = trial % 3 == 0 ? 1.0 : index(random);
    const double theta = trial % 7 == 0 ? 0.0 : unit(random) * 0.4999 * std::numbers::pi;
    const FilmResponse r = film_response(n_in, films, n_out, theta, lambda(random));
    const bool ok = std::abs(r.R_s + r.T_s - 1.0) <= 1e-12 && std::abs(r.R_p + r.T_p - 1.0) <= 1e-12;
    if (!ok) {
      INFO("trial ", trial, " s ", r.R_s + r.T_s - 1.0, " p ", r.R_p + r.T_p - 1.0);
      CHECK(ok);
    }
  }
}

TEST_CASE("a quarter-wave film at its design wavelength and normal incidence has the textbook reflectance") {
  // ((n1^2 - n0 n2) / (n1^2 + n0 n2))^2, Hecht eq. 9.102
  const Coating coating{"", QuarterWave{1.38, 550.0}};
  const double n2 = 1.5168;
  const double expected = std::pow((1.38 * 1.38 - n2) / (1.38 * 1.38 + n2), 2);
  CHECK(reflectance(coating, 1.0, n2, 1.0, 550.0) == test::approx(expected).epsilon(1e-12));
  CHECK(reflectance(coating, n2, 1.0, 1.0, 550.0) == test::approx(expected).epsilon(1e-12));
}

TEST_CASE("the closed form of one film equals its transfer matrix, from both sides, at every angle") {
  const Coating coating{"", QuarterWave{1.38, 520.0}};
  const FilmLayer film{1.38, 520.0 / (4 * 1.38)};
  for (const double lambda : {400.0, 550.0, 700.0}) {
    for (int k = 0; k < 900; ++k) {
      const double theta = k * std::numbers::pi / 1800.0;
      for (const auto& [n0, n2] : {std::pair{1.0, 1.7}, std::pair{1.7, 1.0}, std::pair{1.9, 1.6}}) {
        const double matrix = unpolarised(film_response(n0, {&film, 1}, n2, theta, lambda));
        CHECK(reflectance(coating, n0, n2, std::cos(theta), lambda) == test::approx(matrix).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("reflectance is the same from both sides along one ray (reversibility)") {
  const Coating stack{"", FilmStack{{{1.38, 99.6}, {2.05, 134.0}, {1.62, 85.0}}}};
  for (const double sine : {0.0, 0.3, 0.6, 0.95}) {
    const double cos_air = std::sqrt(1.0 - sine * sine);
    const double cos_glass = std::sqrt(1.0 - std::pow(sine / 1.6, 2));
    CHECK(reflectance(stack, 1.0, 1.6, cos_air, 500.0) ==
          test::approx(reflectance(stack, 1.6, 1.0, cos_glass, 500.0)).epsilon(1e-11));
  }
}

TEST_CASE("bare glass: Fresnel at normal incidence, Brewster's angle, total reflection") {
  const Coating bare;
  CHECK(reflectance(bare, 1.0, 1.5, 1.0, 550.0) == test::approx(0.04).epsilon(1e-12));
  const double brewster = std::atan(1.5);
  const FilmResponse r = film_response(1.0, {}, 1.5, brewster, 550.0);
  CHECK(r.R_p < 1e-30);
  CHECK(reflectance(bare, 1.0, 1.5, std::cos(brewster), 550.0) == test::approx(0.5 * r.R_s).epsilon(1e-12));
  CHECK(reflectance(bare, 1.5, 1.0, 0.5, 550.0) == 1.0);
  CHECK(reflectance(bare, 1.0, 1.5, 0.0, 550.0) == test::approx(1.0));
}

TEST_CASE("hullin2011's printed formula reflects 24 per cent too much for MgF2 on crown glass") {
  const double printed = reflectance({"", HullinFresnelAR{1.38, 550.0}}, 1.0, 1.5168, 1.0, 550.0);
  const double exact = reflectance({"", QuarterWave{1.38, 550.0}}, 1.0, 1.5168, 1.0, 550.0);
  CHECK(printed / exact == test::approx(1.24).epsilon(0.01));
}

TEST_CASE("an absorbing film transmits less than it does not reflect") {
  const Coating metal{"", FilmStack{{{{0.2, 3.0}, 10.0}}}};
  const double r = reflectance(metal, 1.0, 1.5, 0.9, 550.0);
  const double t = transmittance(metal, 1.0, 1.5, 0.9, 550.0);
  CHECK(r > 0.0);
  CHECK(t > 0.0);
  CHECK(r + t < 0.99);
}
