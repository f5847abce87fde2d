// SPDX-License-Identifier: Apache-2.0
// contrejour coating fit: finds coatings whose reflection has an observed colour. Makers do not publish their films
// (hullin2011, 3.1), but the colour of a reflection is a constraint on them.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/reflected_colour.h"
#include "cli/substrate_option.h"
#include "cli/text_table.h"
#include "contrejour/expert/film_design.h"

namespace contrejour::cli {
namespace {

constexpr const char* kCoatingFitExamples =
    "COLOUR is the colour of white light that a coated surface reflects at normal incidence: #rrggbb as picked from\n"
    "a picture, or scene-linear R,G,B. The best coating of each family is printed as a value of --coating, with its\n"
    "difference from that colour in u'v' (0.002 is barely visible) and its reflectance of daylight.\n\n"
    "Examples:\n"
    "  contrejour coating fit '#7a4cff'\n"
    "  contrejour coating fit 0.2,0.9,0.4 --glass 1.85,23.8 --json";

constexpr double kColourWeight = 20.0;  // weight of a difference in u'v' relative to one in reflectance
constexpr std::array kStartWavelengths_nm{450.0, 500.0, 550.0, 600.0, 650.0};

struct FitOptions {
  std::string colour, glass;
  bool json = false;
};

struct Fit {
  std::string family;
  FilmStack stack;
  Xyz colour{};
  double difference = 0.0;  // in u'v'
};

// CIE 1976 u', v'.
std::array<double, 2> uv_of(const std::array<double, 2>& xy) {
  const double scale = 1.0 / (-2.0 * xy[0] + 12.0 * xy[1] + 3.0);
  return {4.0 * xy[0] * scale, 9.0 * xy[1] * scale};
}

std::array<double, 2> colour_difference(const Xyz& colour, const std::array<double, 2>& target_uv) {
  const auto uv = uv_of(chromaticity(colour));
  return {uv[0] - target_uv[0], uv[1] - target_uv[1]};
}

Fit fitted(const std::string& family, const FilmStack& start, const Glass& glass,
           const std::array<double, 2>& target_uv) {
  FilmGoal goal;
  goal.lambda_nm = reflected_wavelengths_nm();
  goal.off = [&](std::span<const double> r) {
    const Xyz colour = reflected_colour(r);
    const auto difference = colour_difference(colour, target_uv);
    return std::vector<double>{kColourWeight * difference[0], kColourWeight * difference[1], colour[1]};
  };
  Fit fit{family, refined(start, glass, goal)};
  // The printed thicknesses, which may be read again, have tenths of nanometres.
  for (FilmLayer& layer : fit.stack.layers) layer.thickness_nm = std::round(10.0 * layer.thickness_nm) / 10.0;
  fit.colour = reflected_colour(reflectances(fit.stack, glass, goal.lambda_nm));
  const auto difference = colour_difference(fit.colour, target_uv);
  fit.difference = std::hypot(difference[0], difference[1]);
  return fit;
}

// The best fit of each family, the nearest colour first.
std::vector<Fit> all_fits(const Glass& glass, const std::array<double, 2>& target_uv) {
  std::vector<Fit> best;
  const auto better = [](const Fit& a, const Fit& b) { return a.difference < b.difference; };
  const auto add_best = [&](const std::vector<Fit>& tried) {
    best.push_back(*std::min_element(tried.begin(), tried.end(), better));
  };
  std::vector<Fit> single;
  for (const double nm : kStartWavelengths_nm) {
    const FilmMaterial film = film_material("MgF2");
    single.push_back(fitted("one film", {{{film, nm / (4.0 * index_at(film, nm).real())}}}, glass, target_uv));
  }
  add_best(single);
  for (const std::string& name : coating_design_names()) {
    std::vector<Fit> tried;
    for (const double nm : kStartWavelengths_nm) {
      DesignedCoating design = *find_coating_design(name);
      design.lambda0_nm = nm;
      tried.push_back(fitted(name, designed_for(design, glass), glass, target_uv));
    }
    add_best(tried);
  }
  std::stable_sort(best.begin(), best.end(), better);
  return best;
}

std::string stack_text(const FilmStack& stack) {
  std::string text;
  for (const FilmLayer& layer : stack.layers)
    text += fmt::format("{}{}@{:.1f}", text.empty() ? "stack:" : ",", layer.material.name, layer.thickness_nm);
  return text;
}

Result<int> run_fit(const FitOptions& options) {
  const auto glass = parse_substrate(options.glass);
  if (!glass) return tl::unexpected(glass.error());
  const auto target = parse_chromaticity(options.colour);
  if (!target) return tl::unexpected(target.error());
  const std::vector<Fit> fits = all_fits(*glass, uv_of(*target));
  if (options.json) {
    Json list = Json::array();
    for (const Fit& fit : fits) {
      list.push_back({{"family", fit.family},
                      {"coating", stack_text(fit.stack)},
                      {"difference_uv", fit.difference},
                      {"luminous_reflectance", fit.colour[1]},
                      {"shown_as", srgb_text(fit.colour)}});
    }
    print_json({{"chromaticity", *target}, {"fits", list}});
    return kDone;
  }
  TextTable table({"<family", "difference, u'v'", "R %", "<colour", "<--coating"});
  for (const Fit& fit : fits)
    table.add({fit.family, fmt::format("{:.4f}", fit.difference), fmt::format("{:.2f}", 100.0 * fit.colour[1]),
               srgb_text(fit.colour), stack_text(fit.stack)});
  print(table.text());
  return kDone;
}

}  // namespace

void add_coating_fit(CLI::App& coating, Action& action) {
  const auto options = std::make_shared<FitOptions>();
  CLI::App* command = coating.add_subcommand("fit", "find coatings that reflect an observed colour");
  command->add_option("COLOUR", options->colour, "colour of the reflection")->required()->option_text(" ");
  add_substrate_option(*command, options->glass);
  command->add_flag("--json", options->json, "print JSON");
  command->footer(kCoatingFitExamples);
  command->callback([options, &action] { action = [options] { return run_fit(*options); }; });
}

}  // namespace contrejour::cli
