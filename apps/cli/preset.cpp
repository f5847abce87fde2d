// SPDX-License-Identifier: Apache-2.0
// contrejour preset: lists the bundled presets and shows the settings of one.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/text_table.h"
#include "contrejour/preset.h"

namespace contrejour::cli {
namespace {

Result<std::vector<std::pair<std::string, params::Preset>>> read_bundled_presets() {
  std::vector<std::pair<std::string, params::Preset>> all;
  for (const params::BundledPreset& bundled : params::bundled_presets()) {
    auto preset = params::find_preset(std::string(bundled.name));
    if (!preset) return tl::unexpected(preset.error());
    all.emplace_back(std::string(bundled.name), std::move(*preset));
  }
  return all;
}

Result<int> run_preset_list(bool json) {
  const auto all = read_bundled_presets();
  if (!all) return tl::unexpected(all.error());
  if (json) {
    Json list = Json::array();
    for (const auto& [id, preset] : *all) {
      list.push_back({{"id", id}, {"name", preset.name}, {"description", preset.description}, {"lens", preset.lens}});
    }
    print_json({{"looks", list}});
    return kDone;
  }
  TextTable table({"<preset", "<lens", "<description"});
  for (const auto& [id, preset] : *all) table.add({id, preset.lens, preset.description});
  print(table.text());
  return kDone;
}

// Prints a preset file, or JSON with every value as its text.
Result<int> run_preset_show(const std::string& name, bool json) {
  const auto preset = params::find_preset(name);
  if (!preset) return tl::unexpected(preset.error());
  if (!json) {
    print(params::write_preset(*preset));
    return kDone;
  }
  Json values = Json::object();
  for (const params::Parameter& p : params::all_parameters()) {
    if (!params::belongs_to_preset(p)) continue;
    if (const auto text = preset->values.text(p.name)) values[std::string(p.name)] = *text;
  }
  print_json(
      {{"name", preset->name}, {"description", preset->description}, {"lens", preset->lens}, {"values", values}});
  return kDone;
}

void add_preset_list(CLI::App& preset, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = preset.add_subcommand("list", "list the bundled presets");
  command->add_flag("--json", *json, "print JSON");
  command->footer("Examples:\n  contrejour preset list\n  contrejour preset list --json");
  command->callback([json, &action] { action = [json] { return run_preset_list(*json); }; });
}

void add_preset_show(CLI::App& preset, Action& action) {
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = preset.add_subcommand("show", "show every setting of a preset");
  command->add_option("PRESET", *name, "a bundled preset or a file")->required()->option_text(" ");
  command->add_flag("--json", *json, "print JSON");
  command->footer("Examples:\n  contrejour preset show old-portrait\n  contrejour preset show mine.toml --json");
  command->callback([name, json, &action] { action = [name, json] { return run_preset_show(*name, *json); }; });
}

}  // namespace

void add_preset(CLI::App& app, Action& action) {
  CLI::App* preset = app.add_subcommand("preset", "list and show presets, which are named sets of settings");
  preset->alias("look");  // its earlier name
  preset->require_subcommand(1);
  add_preset_list(*preset, action);
  add_preset_show(*preset, action);
}

}  // namespace contrejour::cli
