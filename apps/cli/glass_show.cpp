// SPDX-License-Identifier: Apache-2.0
// contrejour glass show: describes one glass in the form of a data sheet.
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/glass_choice.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

struct GlassShowOptions {
  std::string name;
  std::vector<std::string> catalogues, makers;
  bool json = false;
};

struct SpectralLine {
  const char* name;
  double nm;
};
constexpr SpectralLine kSpectralLines[] = {{"i", kLineI_nm}, {"h", kLineH_nm}, {"g", kLineG_nm}, {"F'", kLineFPrime_nm},
                                           {"F", kLineF_nm}, {"e", kLineE_nm}, {"d", kLineD_nm}, {"C'", kLineCPrime_nm},
                                           {"C", kLineC_nm}, {"r", kLineR_nm}};
constexpr double kPath_mm = 10.0;

const GlassData* data_of(const Glass& glass) {
  const auto* known = std::get_if<CatalogueGlass>(&glass.dispersion);
  return known == nullptr ? nullptr : &known->data();
}

bool within_range(const Glass& glass, double nm) {
  const auto range = wavelength_range_nm(glass);
  return !range || (nm >= range->first_nm && nm <= range->last_nm);
}

std::string formula_of(const Glass& glass) {
  const GlassData* data = data_of(glass);
  return data == nullptr ? "model" : std::string(formula_name(data->formula));
}

bool has_transmittance(const Glass& glass) { return data_of(glass) != nullptr && !data_of(glass)->absorption.empty(); }

Json lines_json(const Glass& glass) {
  Json list = Json::array();
  for (const SpectralLine& line : kSpectralLines) {
    const double n = refractive_index(glass, line.nm);
    list.push_back({{"line", line.name},
                    {"wavelength_nm", line.nm},
                    {"n", std::isfinite(n) ? Json(n) : Json()},
                    {"within_range", within_range(glass, line.nm)},
                    {"transmittance",
                     has_transmittance(glass) ? Json(internal_transmittance(glass, line.nm, kPath_mm)) : Json()}});
  }
  return list;
}

Json show_json(const CatalogueEntry& entry) {
  const GlassFigures figures = glass_figures(entry.glass);
  const GlassData* data = data_of(entry.glass);
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  const auto range = wavelength_range_nm(entry.glass);
  return {{"name", entry.summary.name},
          {"maker", entry.summary.maker},
          {"status", status_name(entry.summary.status)},
          {"code", entry.summary.code},
          {"source", entry.source},
          {"formula", formula_of(entry.glass)},
          {"coefficients", data == nullptr ? Json::array() : Json(data->coefficients)},
          {"wavelength_range_nm", range ? Json::array({range->first_nm, range->last_nm}) : Json()},
          {"reference_temperature_c", data == nullptr ? Json() : Json(data->reference_temperature_c)},
          {"n_d", number(figures.n_d)},
          {"v_d", number(figures.v_d)},
          {"v_e", number(figures.v_e)},
          {"p_gf", number(figures.p_gf)},
          {"d_pgf", number(figures.d_pgf)},
          {"path_mm", kPath_mm},
          {"lines", lines_json(entry.glass)}};
}

std::string lines_text(const Glass& glass) {
  TextTable table({"<line", "nm", "n", "internal transmittance of 10 mm"});
  for (const SpectralLine& line : kSpectralLines) {
    const bool within = within_range(glass, line.nm);
    const double n = refractive_index(glass, line.nm);
    table.add({line.name, fmt::format("{:.4f}", line.nm),
               std::isfinite(n) ? fmt::format("{:.6f}{}", n, within ? " " : "*") : "none ",
               has_transmittance(glass) ? fmt::format("{:.4f}", internal_transmittance(glass, line.nm, kPath_mm))
                                        : "unknown"});
  }
  return table.text();
}

std::string show_text(const CatalogueEntry& entry) {
  const GlassFigures f = glass_figures(entry.glass);
  std::string text = fmt::format(
      "{} {}{}{}\n", entry.summary.maker, entry.summary.name,
      entry.summary.code.empty() ? "" : ", " + entry.summary.code,
      entry.summary.status == GlassStatus::Standard ? "" : fmt::format(", {}", status_name(entry.summary.status)));
  if (const GlassData* data = data_of(entry.glass)) {
    text += fmt::format("formula {}", formula_name(data->formula));
    if (data->formula == DispersionFormula::Table) {
      text += fmt::format(" of {} wavelengths", data->coefficients.size() / 2);
    } else {
      text += fmt::format(": {}", fmt::join(data->coefficients, " "));
    }
    if (data->range_nm)
      text += fmt::format("\nfrom {:g} to {:g} nm", data->range_nm->first_nm, data->range_nm->last_nm);
    text += fmt::format(", at {:g} deg C\n", data->reference_temperature_c);
  } else {
    text += "model glass with this n_d and V_d and a normal partial dispersion\n";
  }
  text += fmt::format("n_d {:.6f}  V_d {:.3f}  V_e {:.3f}  P_gF {:.5f}  dP_gF {:+.5f}\n\n", f.n_d, f.v_d, f.v_e, f.p_gf,
                      f.d_pgf);
  text += lines_text(entry.glass);
  for (const SpectralLine& line : kSpectralLines) {
    if (!within_range(entry.glass, line.nm)) return text + "* outside the range of the dispersion formula\n";
  }
  return text;
}

Result<CatalogueEntry> find_glass(const GlassCatalogue& glasses, const GlassShowOptions& options) {
  if (const auto coded = glass_of_code(options.name)) {
    const GlassFigures figures = glass_figures(*coded);
    return CatalogueEntry{
        {options.name, "code", "", GlassStatus::Standard, figures.n_d, figures.v_d}, *coded, "its six digits"};
  }
  return glasses.find(options.name, options.makers);
}

Result<int> run_glass_show(const GlassShowOptions& options) {
  const auto glasses = all_glasses(options.catalogues);
  if (!glasses) return tl::unexpected(glasses.error());
  const auto entry = find_glass(*glasses, options);
  if (!entry) return tl::unexpected(entry.error());
  if (options.json) {
    print_json(show_json(*entry));
  } else {
    print(show_text(*entry));
  }
  return kDone;
}

}  // namespace

void add_glass_show(CLI::App& glass, Action& action) {
  const auto options = std::make_shared<GlassShowOptions>();
  CLI::App* command = glass.add_subcommand("show", "describe a glass in the form of a data sheet");
  command->add_option("NAME", options->name, "a glass, as \"N-BK7\", \"SCHOTT N-BK7\" or a six-digit code")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--maker", options->makers,
                   "search the glasses of this maker; may be repeated, in order of preference")
      ->option_text("MAKER");
  add_catalogue_option(*command, options->catalogues);
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "Examples:\n  contrejour glass show N-BK7\n  contrejour glass show SF4 --maker HIKARI\n  contrejour glass show "
      "517642 --json");
  command->callback([options, &action] { action = [options] { return run_glass_show(*options); }; });
}

}  // namespace contrejour::cli
