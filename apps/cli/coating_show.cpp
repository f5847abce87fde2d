// SPDX-License-Identifier: Apache-2.0
// contrejour coating show: prints and plots a coating's reflectance.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/reflectance_plot.h"
#include "cli/reflected_colour.h"
#include "cli/substrate_option.h"
#include "cli/text_table.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::cli {
namespace {

constexpr const char* kCoatingShowExamples =
    "R is the reflectance of unpolarised light incident from air. COATING is a value of --coating.\n\n"
    "Examples:\n"
    "  contrejour coating show quarter-wave\n"
    "  contrejour coating show broadband-5:540 --glass 1.85,23.8 -o r.svg\n"
    "  contrejour coating show stack:MgF2@0.25w,ZrO2@0.5w,Al2O3@0.25w --json";

constexpr double kTableFirst_nm = 400.0, kTableLast_nm = 700.0, kTableStep_nm = 20.0;
constexpr std::array kTableAngles_deg{0.0, 30.0, 60.0};

struct CoatingShowOptions {
  std::string coating, glass, output;
  bool json = false;
};

double percent_at(const Coating& coating, const Glass& glass, double nm, double angle_deg) {
  const double cos_in = std::cos(angle_deg * std::numbers::pi / 180.0);
  return 100.0 * reflectance(at_wavelength(coating, nm), 1.0, refractive_index(glass, nm), cos_in, nm);
}

// The mean and the largest reflectance at normal incidence, over the range that makers specify.
struct Summary {
  static constexpr double kFirst_nm = 420.0, kLast_nm = 680.0;
  double mean_percent = 0.0, peak_percent = 0.0;
};
Summary summary_of(const Coating& coating, const Glass& glass) {
  Summary out;
  int count = 0;
  for (double nm = Summary::kFirst_nm; nm <= Summary::kLast_nm; nm += 1.0, ++count) {
    const double r = percent_at(coating, glass, nm, 0.0);
    out.mean_percent += r;
    out.peak_percent = std::max(out.peak_percent, r);
  }
  out.mean_percent /= count;
  return out;
}

Xyz colour_of(const Coating& coating, const Glass& glass) {
  std::vector<double> r;
  for (const double nm : reflected_wavelengths_nm()) r.push_back(0.01 * percent_at(coating, glass, nm, 0.0));
  return reflected_colour(r);
}

std::string layers_text(const FilmStack& stack, double lambda_nm) {
  TextTable table({"<film", "n at 550", "nm", "waves"});
  for (const FilmLayer& layer : stack.layers) {
    const auto n = index_at(layer.material, lambda_nm);
    table.add({layer.material.name, fmt::format("{:.4f}", n.real()), fmt::format("{:.1f}", layer.thickness_nm),
               fmt::format("{:.4f}", layer.thickness_nm * n.real() / lambda_nm)});
  }
  return "From the air to the glass:\n" + table.text() + "\n";
}

void print_text(const Coating& coating, const Glass& glass) {
  std::string out = fmt::format("{} on n_d = {:.4f}\n\n", describe(coating), refractive_index(glass, kLineD_nm));
  if (const auto* stack = std::get_if<FilmStack>(&coating.films)) out += layers_text(*stack, 550.0);
  TextTable table({"nm", "R %", "30 deg", "60 deg"});
  for (double nm = kTableFirst_nm; nm <= kTableLast_nm; nm += kTableStep_nm) {
    std::vector<std::string> row{fmt::format("{:g}", nm)};
    for (const double angle : kTableAngles_deg)
      row.push_back(fmt::format("{:.3f}", percent_at(coating, glass, nm, angle)));
    table.add(row);
  }
  const Summary s = summary_of(coating, glass);
  const Xyz colour = colour_of(coating, glass);
  out += table.text();
  out += fmt::format("\n420 to 680 nm: mean {:.3f} %, peak {:.3f} %\ndaylight: {:.3f} %, {}\n", s.mean_percent,
                     s.peak_percent, 100.0 * colour[1], srgb_text(colour));
  print(out);
}

void print_as_json(const Coating& coating, const Glass& glass) {
  Json layers = Json::array();
  if (const auto* stack = std::get_if<FilmStack>(&coating.films)) {
    for (const FilmLayer& layer : stack->layers) {
      const auto n = index_at(layer.material, 550.0);
      layers.push_back({{"material", layer.material.name},
                        {"n_550", n.real()},
                        {"k_550", n.imag()},
                        {"thickness_nm", layer.thickness_nm}});
    }
  }
  Json rows = Json::array();
  for (double nm = kTableFirst_nm; nm <= kTableLast_nm; nm += kTableStep_nm) {
    Json row{{"lambda_nm", nm}};
    for (const double angle : kTableAngles_deg)
      row[fmt::format("reflectance_{:g}deg", angle)] = 0.01 * percent_at(coating, glass, nm, angle);
    rows.push_back(row);
  }
  const Summary s = summary_of(coating, glass);
  const Xyz colour = colour_of(coating, glass);
  print_json({{"coating", describe(coating)},
              {"n_d", refractive_index(glass, kLineD_nm)},
              {"layers", layers},
              {"reflectance", rows},
              {"mean_420_680", 0.01 * s.mean_percent},
              {"peak_420_680", 0.01 * s.peak_percent},
              {"luminous_reflectance", colour[1]},
              {"chromaticity", chromaticity(colour)},
              {"shown_as", srgb_text(colour)}});
}

Result<int> run_coating_show(const CoatingShowOptions& options) {
  const auto glass = parse_substrate(options.glass);
  if (!glass) return tl::unexpected(glass.error());
  const auto requested = params::parse_coating(options.coating);
  if (!requested) return tl::unexpected(requested.error());
  const Coating coating = placed_on(*requested, air(), *glass);
  if (!options.output.empty()) {
    Outputs outputs;
    const auto file = outputs.add(options.output);
    if (!file) return tl::unexpected(file.error());
    const std::string title =
        fmt::format("{} on n = {:.4f}: reflectance", describe(coating), refractive_index(*glass, kLineD_nm));
    if (const auto ok = (*file)->write(reflectance_plot(coating, *glass, title)); !ok)
      return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  options.json ? print_as_json(coating, *glass) : print_text(coating, *glass);
  return kDone;
}

}  // namespace

void add_coating_show(CLI::App& coating, Action& action) {
  const auto options = std::make_shared<CoatingShowOptions>();
  CLI::App* command = coating.add_subcommand("show", "show the reflectance of a coating over wavelength and angle");
  command->add_option("COATING", options->coating, "a coating, as for --coating: a design, a stack, ...")
      ->required()
      ->option_text(" ");
  add_substrate_option(*command, options->glass);
  add_output(*command, "-o,--output", options->output, {".svg"}, "a plot of the reflectance");
  command->add_flag("--json", options->json, "print JSON");
  command->footer(kCoatingShowExamples);
  command->callback([options, &action] { action = [options] { return run_coating_show(*options); }; });
}

}  // namespace contrejour::cli
