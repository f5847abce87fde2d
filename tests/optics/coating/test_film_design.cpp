// SPDX-License-Identifier: Apache-2.0
// Film materials, designs for a glass, refinement, measured coatings.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <numeric>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "contrejour/expert/film_design.h"
#include "shared_data.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

const Glass kBk7{"", Sellmeier{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}};

double normal_reflectance(const Coating& coating, const Glass& glass, double nm) {
  return reflectance(coating, 1.0, refractive_index(glass, nm), 1.0, nm);
}

double mean(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

std::vector<double> every(double first, double last, double step) {
  std::vector<double> nm;
  for (double l = first; l <= last + 1e-9; l += step) nm.push_back(l);
  return nm;
}

}  // namespace

TEST_CASE("film materials have their sources' indices") {
  // Closed forms of the sources, um: Dodge's Sellmeier formula, Malitson's, Al-Kuhaili's Cauchy formula.
  const auto sellmeier = [](double l, std::array<double, 3> b, std::array<double, 3> c) {
    double n2 = 1.0;
    for (std::size_t k = 0; k < 3; ++k) n2 += b[k] * l * l / (l * l - c[k] * c[k]);
    return std::sqrt(n2);
  };
  double worst = 0.0;
  for (const double nm : every(361.0, 829.0, 3.7)) {
    const double l = nm / 1000.0;
    const auto off = [&](const char* name, double expected) {
      worst = std::max(worst, std::abs(index_at(film_material(name), nm).real() - expected));
    };
    off("MgF2", sellmeier(l, {0.48755108, 0.39875031, 2.3120353}, {0.04338408, 0.09461442, 23.793604}));
    off("SiO2", sellmeier(l, {0.6961663, 0.4079426, 0.8974794}, {0.0684043, 0.1162414, 9.896161}));
    off("HfO2", 1.875 + 6.28e-3 / (l * l) + 5.80e-4 / (l * l * l * l));
  }
  CHECK(worst < 2e-5);
  CHECK(index_at(film_material("Ag"), 548.6).imag() == test::approx(3.586).epsilon(0.01));
  CHECK(index_at(film_material("MgF2"), 100.0) == index_at(film_material("MgF2"), 360.0));
  CHECK(index_at(film_material("MgF2"), 5000.0) == index_at(film_material("MgF2"), 830.0));
  for (const FilmMaterialFacts& m : film_materials())
    for (const double nm : every(300.0, 900.0, 7.0)) CHECK(index_at(film_material(m.name), nm).imag() >= 0.0);
  CHECK_FALSE(is_film_material("unobtainium"));
}

TEST_CASE("stacks of published designs reflect what another program says") {
  const auto oracle = test::shared_data("coatings/coating_designs.json");
  if (!oracle) return;
  std::ifstream in(*oracle);
  const auto all = nlohmann::json::parse(in);
  int checked = 0;
  for (const auto& design : all["designs"]) {
    if (!design.contains("n_substrate")) continue;  // glasses are given by name
    FilmStack stack;
    for (const auto& layer : design["layers"])
      stack.layers.push_back({FilmMaterial(layer["n"].get<double>()), layer["thickness_nm"].get<double>()});
    const double n = design["n_substrate"];
    const auto& r = design["R_computed"];
    for (std::size_t k = 0; k < r["lambda_nm"].size(); ++k) {
      const double nm = r["lambda_nm"][k];
      const auto straight = film_response(1.0, stack.layers, n, 0.0, nm);
      const auto aside = film_response(1.0, stack.layers, n, std::numbers::pi / 3.0, nm);
      CHECK(std::abs(straight.R_s - r["R_0deg"][k].get<double>()) < 1e-6);
      CHECK(std::abs(aside.R_s - r["Rs_60deg"][k].get<double>()) < 1e-6);
      CHECK(std::abs(aside.R_p - r["Rp_60deg"][k].get<double>()) < 1e-6);
    }
    ++checked;
  }
  CHECK(checked >= 8);
}

TEST_CASE("a seven-layer coating of dispersive films has its published mean reflectance") {
  // optiland's needle synthesis on N-BK7: 0.388 per cent from 420 to 680 nm.
  const FilmMaterial low = film_material("MgF2"), high = film_material("Al2O3");
  const FilmStack stack{
      {{low, 94.6}, {high, 319.7}, {low, 17.7}, {high, 196.1}, {low, 26.3}, {high, 170.9}, {low, 190.4}}};
  CHECK(mean(reflectances(stack, kBk7, every(420.0, 680.0, 1.0))) == test::approx(0.00388).epsilon(0.01));
}

TEST_CASE("a v-coat reflects nothing at its wavelength, on glasses of any index") {
  for (const double n : {1.45, 1.5168, 1.62, 1.75, 1.85, 1.95, 2.1}) {
    CAPTURE(n);
    for (const double nm : {430.0, 550.0, 700.0}) {
      const Glass glass{"", ConstantIndex{n}};
      const DesignedCoating design{CoatingDesign::VCoat, nm};
      const FilmStack stack = designed_for(design, glass);
      CHECK(normal_reflectance({"", stack}, glass, nm) < (n < 1.9 ? 1e-12 : 5e-3));
      for (const FilmLayer& layer : stack.layers) CHECK(layer.thickness_nm < 200.0);
    }
  }
}

TEST_CASE("designs reflect less than a single film, broadband ones over the whole band, on every glass") {
  const Coating single{"", QuarterWave{}};
  for (const double n : {1.4875, 1.5168, 1.62, 1.7552, 1.8467, 1.92}) {
    CAPTURE(n);
    const Glass glass{"", AbbeGlass{n, 40.0}};
    const auto band = every(430.0, 670.0, 5.0);
    double film = 0.0;
    for (const double nm : band) film += normal_reflectance(single, glass, nm) / static_cast<double>(band.size());
    for (int layers = DesignedCoating::kMinLayers; layers <= DesignedCoating::kMaxLayers; ++layers) {
      CAPTURE(layers);
      const FilmStack stack = designed_for({CoatingDesign::Broadband, 550.0, layers}, glass);
      CHECK(stack.layers.size() == static_cast<std::size_t>(layers));
      CHECK(mean(reflectances(stack, glass, band)) < std::max(0.0015, 0.75 * film));
    }
    const FilmStack qhq = designed_for({CoatingDesign::QuarterHalfQuarter}, glass);
    if (n < 1.65) CHECK(mean(reflectances(qhq, glass, band)) < film);
  }
}

TEST_CASE("a w-coat is that of its outer film at its wavelength, and lower to both sides") {
  const Glass glass{"", ConstantIndex{1.62}};
  const auto r = reflectances(designed_for({CoatingDesign::WCoat}, glass), glass, std::vector{470.0, 550.0, 650.0});
  const double n1 = index_at(film_material("MgF2"), 550.0).real();
  CHECK(r[1] == test::approx(std::pow((n1 * n1 - 1.62) / (n1 * n1 + 1.62), 2.0)).epsilon(1e-9));
  CHECK(r[0] < r[1]);
  CHECK(r[2] < r[1]);
}

TEST_CASE("refinement finds a stack again by its reflectances, and keeps one that has nothing to refine") {
  const FilmMaterial low = film_material("MgF2"), high = film_material("ZrO2");
  const FilmStack truth{{{low, 110.0}, {high, 95.0}}};
  FilmGoal goal{every(400.0, 700.0, 10.0), {}};
  const auto wanted = reflectances(truth, kBk7, goal.lambda_nm);
  goal.off = [&](std::span<const double> r) {
    std::vector<double> off;
    for (std::size_t k = 0; k < r.size(); ++k) off.push_back(r[k] - wanted[k]);
    return off;
  };
  const FilmStack found = refined({{{low, 100.0}, {high, 108.0}}}, kBk7, goal);
  CHECK(found.layers[0].thickness_nm == test::approx(110.0).epsilon(1e-4));
  CHECK(found.layers[1].thickness_nm == test::approx(95.0).epsilon(1e-4));
  CHECK(refined({}, kBk7, goal).layers.empty());
  CHECK(refined(truth, kBk7, {{}, goal.off}) == truth);
}

TEST_CASE("placed coatings lie on the denser side; a wavelength's numbers are those of all") {
  const Coating design{"", DesignedCoating{CoatingDesign::VCoat}};
  const Coating front = placed_on(design, air(), kBk7), back = placed_on(design, kBk7, air());
  CHECK(front == back);
  CHECK(front.name == "v-coat");
  CHECK(placed_on({"", QuarterWave{}}, air(), kBk7) == Coating{"", QuarterWave{}});
  for (const double nm : {400.0, 533.0, 700.0}) {
    const double n = refractive_index(kBk7, nm);
    const Coating fixed = at_wavelength(front, nm);
    for (const double cosine : {1.0, 0.7, 0.2}) {
      CHECK(reflectance(fixed, 1.0, n, cosine, nm) == reflectance(front, 1.0, n, cosine, nm));
      CHECK(transmittance(fixed, n, 1.0, std::sqrt(1.0 - (1.0 - cosine * cosine) / (n * n)), nm) ==
            test::approx(transmittance(front, 1.0, n, cosine, nm)).epsilon(1e-6));
    }
  }
  CHECK(normal_reflectance(design, {"", ConstantIndex{1.5168}}, 550.0) < 1e-12);  // not placed: computed here
}

TEST_CASE("measured coatings are read between their samples, from both sides") {
  const Coating measured{"", MeasuredCoating{{400.0, 500.0}, {0.0, 60.0}, {0.01, 0.05, 0.03, 0.09}}};
  CHECK(reflectance(measured, 1.0, 1.5, 1.0, 400.0) == test::approx(0.01));
  CHECK(reflectance(measured, 1.0, 1.5, 0.5, 500.0) == test::approx(0.09));
  CHECK(reflectance(measured, 1.0, 1.5, std::cos(std::numbers::pi / 6.0), 450.0) == test::approx(0.045));
  CHECK(reflectance(measured, 1.0, 1.5, 1.0, 900.0) == test::approx(0.03));
  CHECK(reflectance(measured, 1.0, 1.5, 0.0, 100.0) == test::approx(0.05));
  const double inside = std::sqrt(1.0 - 0.75 / 2.25);  // 60 degrees in air
  CHECK(reflectance(measured, 1.5, 1.0, inside, 500.0) == test::approx(0.09));
  CHECK(reflectance(measured, 1.5, 1.0, 0.3, 500.0) == 1.0);
  CHECK(transmittance(measured, 1.0, 1.5, 1.0, 400.0) == test::approx(0.99));
}
