// SPDX-License-Identifier: Apache-2.0
// contrejour look: lists the bundled presets and shows the settings of one.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/text_table.h"
#include "contrejour/look.h"

namespace contrejour::cli {
namespace {

Result<std::vector<std::pair<std::string, params::Look>>> read_bundled_looks() {
  std::vector<std::pair<std::string, params::Look>> all;
  for (const params::BundledLook& bundled : params::bundled_looks()) {
    auto look = params::find_look(std::string(bundled.name));
    if (!look) return tl::unexpected(look.error());
    all.emplace_back(std::string(bundled.name), std::move(*look));
  }
  return all;
}

Result<int> run_look_list(bool json) {
  const auto all = read_bundled_looks();
  if (!all) return tl::unexpected(all.error());
  if (json) {
    Json list = Json::array();
    for (const auto& [id, look] : *all) {
      list.push_back({{"id", id}, {"name", look.name}, {"description", look.description}, {"lens", look.lens}});
    }
    print_json({{"looks", list}});
    return kDone;
  }
  TextTable table({"<preset", "<lens", "<description"});
  for (const auto& [id, look] : *all) table.add({id, look.lens, look.description});
  print(table.text());
  return kDone;
}

// Prints a preset file, or JSON with every value as its text.
Result<int> run_look_show(const std::string& name, bool json) {
  const auto look = params::find_look(name);
  if (!look) return tl::unexpected(look.error());
  if (!json) {
    print(params::write_look(*look));
    return kDone;
  }
  Json values = Json::object();
  for (const params::Parameter& p : params::all_parameters()) {
    if (!params::belongs_to_look(p)) continue;
    if (const auto text = look->values.text(p.name)) values[std::string(p.name)] = *text;
  }
  print_json({{"name", look->name}, {"description", look->description}, {"lens", look->lens}, {"values", values}});
  return kDone;
}

void add_look_list(CLI::App& look, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = look.add_subcommand("list", "list the bundled presets");
  command->add_flag("--json", *json, "print JSON");
  command->footer("Examples:\n  contrejour look list\n  contrejour look list --json");
  command->callback([json, &action] { action = [json] { return run_look_list(*json); }; });
}

void add_look_show(CLI::App& look, Action& action) {
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = look.add_subcommand("show", "show every setting of a preset");
  command->add_option("PRESET", *name, "a bundled preset or a file")->required()->option_text(" ");
  command->add_flag("--json", *json, "print JSON");
  command->footer("Examples:\n  contrejour look show heliar-backlight\n  contrejour look show mine.toml --json");
  command->callback([name, json, &action] { action = [name, json] { return run_look_show(*name, *json); }; });
}

}  // namespace

void add_look(CLI::App& app, Action& action) {
  CLI::App* look = app.add_subcommand("look", "list and show presets, which are named sets of settings");
  look->alias("preset");
  look->require_subcommand(1);
  add_look_list(*look, action);
  add_look_show(*look, action);
}

}  // namespace contrejour::cli
