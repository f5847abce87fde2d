// SPDX-License-Identifier: Apache-2.0
// All keys, over everything else; from the table of keys.
#include <string_view>

#include "studio/ui/keys.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

void draw_group(std::string_view group) {
  ImGui::PushFont(medium_font());
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(colours::kAccent), "%s", std::string(group).c_str());
  ImGui::PopFont();
  for (const KeyCommand& key : all_keys()) {
    if (key.group != group || *key.what == '\0') continue;
    ImGui::TextUnformatted(key.shown);
    ImGui::SameLine(scaled(104));
    ImGui::TextDisabled("%s", key.what);
  }
  ImGui::Spacing();
}

}  // namespace

void draw_help_overlay(Ui& ui) {
  if (!ui.state.shows_help) return;
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowBgAlpha(1);
  constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(scaled(24), scaled(18)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, scaled(8));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("##help", nullptr, flags);
  ImGui::SetWindowFocus();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(scaled(8), scaled(2)));
  ImGui::BeginTable("keys", 3, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  for (const char* group : {"Files", "History", "Lights"}) draw_group(group);
  ImGui::TableNextColumn();
  for (const char* group : {"Ghosts", "View", "Compare"}) draw_group(group);
  ImGui::TableNextColumn();
  for (const char* group : {"Frames", "Panels"}) draw_group(group);
  ImGui::EndTable();
  ImGui::PopStyleVar();
  ImGui::TextDisabled(
      "Wheel: zoom.  Right button: pan.  Click: the ghost there.  A number: drag it, or click it and type.  "
      "Esc closes this.");
  ui.registry.record("help");
  ImGui::End();
  ImGui::PopStyleVar(3);
}

}  // namespace contrejour::studio
