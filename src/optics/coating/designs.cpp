// SPDX-License-Identifier: Apache-2.0
// Coatings that are designed for a glass.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contrejour/expert/film_design.h"

namespace contrejour {
namespace {

constexpr double kBand = 0.236;   // of lambda0, to either side
constexpr int kBandSamples = 25;

FilmLayer film(std::string_view material, double waves, double lambda0_nm) {
  const FilmMaterial m = film_material(material);
  return {m, waves * lambda0_nm / index_at(m, lambda0_nm).real()};
}

FilmGoal lowest(double lambda0_nm, double band, int samples) {
  FilmGoal goal;
  for (int k = 0; k < samples; ++k)
    goal.lambda_nm.push_back(samples == 1 ? lambda0_nm : lambda0_nm * (1.0 - band + 2.0 * band * k / (samples - 1)));
  goal.off = [](std::span<const double> r) { return std::vector<double>(r.begin(), r.end()); };
  return goal;
}

// Two films of indices n1 (at the air) and n2 with zero reflectance at lambda0; Macleod 3.2.1 (Catalan). If no
// thicknesses achieve this (a glass of high index), the lowest reflectance.
FilmStack v_coat(double lambda0_nm, const Glass& glass) {
  FilmStack stack{{film("MgF2", 0.25, lambda0_nm), film("ZrO2", 0.06, lambda0_nm)}};
  const double n1 = index_at(stack.layers[0].material, lambda0_nm).real();
  const double n2 = index_at(stack.layers[1].material, lambda0_nm).real();
  const double ns = refractive_index(glass, lambda0_nm);
  const double matching = n1 * n1 * ns - n2 * n2, over = n2 * n2 - ns, under = n1 * n1 - ns;
  const double tan1 = (ns - 1.0) * over * n1 * n1 / (matching * -under);
  const double tan2 = (ns - 1.0) * -under * n2 * n2 / (matching * over);
  if (!(tan1 > 0.0 && tan2 > 0.0)) return refined(stack, glass, lowest(lambda0_nm, 0.0, 1));
  // tan(delta1) tan(delta2) = n1 n2 (ns - 1) / (n1^2 ns - n2^2): its sign determines which branches belong together.
  const double second = std::atan(std::sqrt(tan2));
  const double first = matching > 0.0 ? std::atan(std::sqrt(tan1)) : std::numbers::pi - std::atan(std::sqrt(tan1));
  stack.layers[0].thickness_nm = first * lambda0_nm / (2.0 * std::numbers::pi * n1);
  stack.layers[1].thickness_nm = second * lambda0_nm / (2.0 * std::numbers::pi * n2);
  return stack;
}

// Thicknesses for glass of n = 1.52 at 550 nm: the best result of refining 400 random starts, without very thin films
// and thick stacks.
constexpr std::array<std::array<double, DesignedCoating::kMaxLayers>, 4> kBroadband_nm = {{
    {95.1, 126.4, 36.5, 13.9},
    {93.8, 123.9, 42.4, 11.2, 99.7},
    {100.9, 42.9, 15.2, 57.4, 37.3, 14.6},
    {86.5, 109.8, 168.3, 119.5, 43.0, 10.1, 96.1},
}};

FilmStack broadband(const DesignedCoating& design, const Glass& glass) {
  const int layers = std::clamp(design.layers, DesignedCoating::kMinLayers, DesignedCoating::kMaxLayers);
  const auto& start = kBroadband_nm[static_cast<std::size_t>(layers - DesignedCoating::kMinLayers)];
  FilmStack stack;
  for (int k = 0; k < layers; ++k) {
    const std::string_view material = k == 0 ? "MgF2" : k % 2 == 1 ? "Ta2O5" : "SiO2";
    stack.layers.push_back({film_material(material), start[static_cast<std::size_t>(k)] * design.lambda0_nm / 550.0});
  }
  return refined(stack, glass, lowest(design.lambda0_nm, kBand, kBandSamples));
}

// All designs, at 550 nm.
std::vector<DesignedCoating> all_designs() {
  std::vector<DesignedCoating> all;
  for (const CoatingDesign design : {CoatingDesign::VCoat, CoatingDesign::WCoat, CoatingDesign::QuarterHalfQuarter})
    all.push_back({design});
  for (int layers = DesignedCoating::kMinLayers; layers <= DesignedCoating::kMaxLayers; ++layers)
    all.push_back({CoatingDesign::Broadband, 550.0, layers});
  return all;
}

}  // namespace

std::string design_name(const DesignedCoating& design) {
  switch (design.design) {
    case CoatingDesign::VCoat: return "v-coat";
    case CoatingDesign::WCoat: return "w-coat";
    case CoatingDesign::QuarterHalfQuarter: return "quarter-half-quarter";
    case CoatingDesign::Broadband: break;
  }
  return "broadband-" + std::to_string(design.layers);
}

std::vector<std::string> coating_design_names() {
  std::vector<std::string> names;
  for (const DesignedCoating& design : all_designs()) names.push_back(design_name(design));
  return names;
}

std::optional<DesignedCoating> find_coating_design(std::string_view name) {
  for (const DesignedCoating& design : all_designs())
    if (design_name(design) == name) return design;
  return std::nullopt;
}

FilmStack designed_for(const DesignedCoating& design, const Glass& glass) {
  const double nm = design.lambda0_nm;
  switch (design.design) {
    case CoatingDesign::VCoat: return v_coat(nm, glass);
    case CoatingDesign::WCoat: return {{film("MgF2", 0.25, nm), film("Y2O3", 0.5, nm)}};
    case CoatingDesign::QuarterHalfQuarter:
      return {{film("MgF2", 0.25, nm), film("ZrO2", 0.5, nm), film("Al2O3", 0.25, nm)}};
    case CoatingDesign::Broadband: break;
  }
  return broadband(design, glass);
}

Coating placed_on(const Coating& coating, const Glass& before, const Glass& after) {
  const auto* const design = std::get_if<DesignedCoating>(&coating.films);
  if (design == nullptr) return coating;
  const bool denser_behind = refractive_index(after, design->lambda0_nm) > refractive_index(before, design->lambda0_nm);
  return {coating.name.empty() ? design_name(*design) : coating.name,
          designed_for(*design, denser_behind ? after : before)};
}

}  // namespace contrejour
