// SPDX-License-Identifier: Apache-2.0
// contrejour coating: lists coatings, shows their reflectance, and fits one to an observed colour.
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/reflected_colour.h"
#include "cli/text_table.h"
#include "contrejour/expert/film_design.h"

namespace contrejour::cli {
namespace {

constexpr double kListedAt_nm = 550.0;

Result<int> run_coating_list(bool json) {
  if (json) {
    Json materials = Json::array();
    for (const FilmMaterialFacts& m : film_materials()) {
      const auto n = index_at(film_material(m.name), kListedAt_nm);
      materials.push_back({{"name", m.name}, {"n_550", n.real()}, {"k_550", n.imag()}, {"source", m.source}});
    }
    print_json({{"designs", coating_design_names()}, {"materials", materials}});
    return kDone;
  }
  const Glass glass{"", AbbeGlass{1.5168, 64.17}};
  const auto nm = reflected_wavelengths_nm();
  TextTable designs({"<design", "films", "R on n 1.517, %", "<colour"});
  for (const std::string& name : coating_design_names()) {
    const FilmStack stack = designed_for(*find_coating_design(name), glass);
    const Xyz colour = reflected_colour(reflectances(stack, glass, nm));
    designs.add(
        {name, fmt::format("{}", stack.layers.size()), fmt::format("{:.2f}", 100.0 * colour[1]), srgb_text(colour)});
  }
  TextTable materials({"<film material", "n at 550", "k", "<source"});
  for (const FilmMaterialFacts& m : film_materials()) {
    const auto n = index_at(film_material(m.name), kListedAt_nm);
    materials.add({std::string(m.name), fmt::format("{:.4f}", n.real()),
                   n.imag() > 0.0 ? fmt::format("{:.2g}", n.imag()) : "", std::string(m.source)});
  }
  print("A coating is none, quarter-wave[:NM[:N]], stack:MATERIAL|N@NM|WAVESw,..., or a design, NAME[:NM]:\n\n" +
        designs.text() + "\n" + materials.text());
  return kDone;
}

void add_coating_list(CLI::App& coating, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = coating.add_subcommand("list", "list the bundled coating designs and film materials");
  command->add_flag("--json", *json, "print JSON");
  command->footer("Examples:\n  contrejour coating list\n  contrejour coating list --json");
  command->callback([json, &action] { action = [json] { return run_coating_list(*json); }; });
}

}  // namespace

void add_coating(CLI::App& app, Action& action) {
  CLI::App* coating = app.add_subcommand("coating", "list, show and fit anti-reflection coatings");
  coating->require_subcommand(1);
  coating->footer(
      "Examples:\n"
      "  contrejour coating list\n"
      "  contrejour coating show broadband-5 -o r.svg\n"
      "  contrejour coating fit '#7a4cff'");
  add_coating_list(*coating, action);
  add_coating_show(*coating, action);
  add_coating_fit(*coating, action);
}

}  // namespace contrejour::cli
