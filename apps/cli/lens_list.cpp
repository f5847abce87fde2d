// SPDX-License-Identifier: Apache-2.0
// contrejour lens list: the bundled lenses.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/text_table.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/lens.h"

namespace contrejour::cli {
namespace {

struct ListedLens {
  std::string id;
  Prescription lens;
  LensState state;
};

Result<std::vector<ListedLens>> read_bundled_lenses() {
  std::vector<ListedLens> all;
  for (const BundledLens& bundled : bundled_lenses()) {
    auto lens = read_lens_toml(bundled.toml, std::string(bundled.name));
    if (!lens) return tl::unexpected(lens.error());
    auto state = configure_lens(*lens);
    if (!state) return tl::unexpected(state.error());
    all.push_back({std::string(bundled.name), std::move(*lens), std::move(*state)});
  }
  return all;
}

std::string focal_range(const ListedLens& entry) {
  const auto& zoom = entry.lens.zoom;
  if (zoom.empty()) return fmt::format("{:.4g}", entry.state.focal_length_mm);
  return fmt::format("{:.4g}-{:.4g}", zoom.front().focal_length_mm, zoom.back().focal_length_mm);
}

Json list_json(const std::vector<ListedLens>& all) {
  Json list = Json::array();
  for (const ListedLens& entry : all) {
    Json zoom = Json::array();
    for (const ZoomPosition& position : entry.lens.zoom) zoom.push_back(position.focal_length_mm);
    list.push_back({{"id", entry.id},
                    {"name", entry.lens.name},
                    {"source", entry.lens.source},
                    {"focal_length_mm", entry.state.focal_length_mm},
                    {"zoom", zoom},
                    {"f_number", entry.lens.f_number},
                    {"surface_count", entry.lens.surfaces.size()},
                    {"ghost_count", enumerate_ghosts(entry.state, GhostScope::All).size()}});
  }
  return {{"lenses", list}};
}

std::string list_text(const std::vector<ListedLens>& all) {
  TextTable table({"<lens", "focal mm", "f/", "surfaces", "ghosts", "<name", "<source"});
  for (const ListedLens& entry : all) {
    table.add({entry.id, focal_range(entry), fmt::format("{:g}", entry.lens.f_number),
               fmt::format("{}", entry.lens.surfaces.size()),
               fmt::format("{}", enumerate_ghosts(entry.state, GhostScope::All).size()), entry.lens.name,
               entry.lens.source});
  }
  return table.text();
}

Result<int> run_lens_list(bool json) {
  const auto all = read_bundled_lenses();
  if (!all) return tl::unexpected(all.error());
  if (json) {
    print_json(list_json(*all));
  } else {
    print(list_text(*all));
  }
  return kDone;
}

}  // namespace

void add_lens_list(CLI::App& lens, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = lens.add_subcommand("list", "list the bundled lenses");
  command->add_flag("--json", *json, "print JSON");
  command->footer("Examples:\n  contrejour lens list\n  contrejour lens list --json");
  command->callback([json, &action] { action = [json] { return run_lens_list(*json); }; });
}

}  // namespace contrejour::cli
