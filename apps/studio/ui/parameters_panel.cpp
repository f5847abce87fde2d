// SPDX-License-Identifier: Apache-2.0
// Every parameter of the one table, by its groups. A parameter that is new in the table appears here by itself.
#include <algorithm>
#include <vector>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/ui/panels.h"
#include "studio/ui/parameter_widgets.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

using params::Parameter;

// Lights have a panel of their own, ghosts and coatings of surfaces too; threads are the machine's.
bool has_panel_of_its_own(const Parameter& p) {
  return p.name == "light" || p.name == "light-at" || p.name == "threads";
}

// Lights are found in plates only.
bool is_of_use(const Ui& ui, const Parameter& p) {
  return !has_panel_of_its_own(p) && (p.group != "Light detection" || ui.studio.document().has_plate());
}

bool fits_filter(const Parameter& p, const std::string& filter) {
  return contains_in_any_case(p.name, filter) || contains_in_any_case(p.help, filter) ||
         contains_in_any_case(label_of(p), filter);
}

bool is_shown(const Ui& ui, const Parameter& p) {
  return is_of_use(ui, p) && fits_filter(p, ui.state.parameter_filter);
}

// The groups that have a parameter to show.
std::vector<std::string_view> groups(const Ui& ui) {
  std::vector<std::string_view> names;
  for (const Parameter& p : params::all_parameters())
    if (is_shown(ui, p) && std::find(names.begin(), names.end(), p.group) == names.end()) names.push_back(p.group);
  return names;
}

}  // namespace

void draw_parameters_panel(Ui& ui) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##filter", "Find a parameter", &ui.state.parameter_filter);
  ui.registry.record("parameters/filter", ui.state.parameter_filter);
  ImGui::BeginChild("##parameters");
  const auto shown = groups(ui);
  if (shown.empty()) ImGui::TextDisabled("No parameter has this in its name or its help.");
  for (const std::string_view group : shown) {
    ImGui::PushFont(medium_font());
    const bool open = ImGui::CollapsingHeader(std::string(group).c_str(), ImGuiTreeNodeFlags_DefaultOpen);
    ImGui::PopFont();
    ui.registry.record(std::string("parameters/group/").append(group));
    if (!open) continue;
    for (const Parameter& p : params::all_parameters())
      if (p.group == group && is_shown(ui, p)) draw_parameter(ui, p);
  }
  ImGui::EndChild();
}

}  // namespace contrejour::studio
