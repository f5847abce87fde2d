// SPDX-License-Identifier: Apache-2.0
// Export: what, where, and the command line that makes the same.
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "studio/core/command_line.h"
#include "studio/core/plate_frames.h"
#include "studio/ui/file_dialog.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr float kDialogWidth = 560;

// The name keeps its folder, and follows the kind.
void choose_kind(Ui& ui, ExportKind kind) {
  ui.state.export_kind = kind;
  const auto folder = std::filesystem::path(ui.state.path).parent_path();
  ui.state.path = (folder / file_to_export(ui)).string();
}

void draw_kinds(Ui& ui) {
  for (const ExportKind kind : kExportKinds) {
    const bool chosen = ui.state.export_kind == kind;
    if (kind != kExportKinds.front()) ImGui::SameLine(0, scaled(4));
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, colours::kAccentDim);
    const bool pressed = button(ui, fmt::format("export/kind/{}", name_of(kind)), name_of(kind), help_of(kind));
    if (chosen) ImGui::PopStyleColor();
    if (pressed) choose_kind(ui, kind);
  }
  ImGui::TextDisabled("%s", help_of(ui.state.export_kind));
}

void draw_layers_choice(Ui& ui) {
  static constexpr std::array kBy = {"by light", "by ghost: the ten brightest and the rest",
                                     "by part: ghosts, starburst, glare", "by surface of the first reflection"};
  ImGui::SetNextItemWidth(scaled(kDialogWidth));
  ImGui::Combo("##layers", &ui.state.export_layers, kBy.data(), static_cast<int>(kBy.size()));
  ui.registry.record("export/layers", kBy[static_cast<std::size_t>(ui.state.export_layers)]);
}

void draw_command(Ui& ui, const char* what, const std::string& id, const std::string& command) {
  if (command.empty()) return;
  ImGui::TextDisabled("%s", what);
  std::string shown = command;
  ImGui::SetNextItemWidth(scaled(kDialogWidth - 76));
  ImGui::InputText(("##" + id).c_str(), shown.data(), shown.size() + 1, ImGuiInputTextFlags_ReadOnly);
  ui.registry.record("export/" + id, command);
  tip(command.c_str());
  ImGui::SameLine();
  if (button(ui, "export/" + id + "/copy", "Copy", nullptr, {scaled(68), 0})) ImGui::SetClipboardText(command.c_str());
}

void draw_commands(Ui& ui) {
  const Document& document = ui.studio.document();
  const View& view = ui.studio.view;
  const auto frames = ui.studio.plate_frames();
  const CommandChoice choice{
      .kind = ui.state.export_kind,
      .output = ui.state.path,
      .layers_by = static_cast<LayersBy>(ui.state.export_layers),
      .first = view.first_frame,
      .last = view.last_frame,
      .frame = view.frame,
      .skips_missing = !frames.empty() && !missing_frames(frames, view.first_frame, view.last_frame).empty()};
  const bool is_saved = !ui.studio.file().empty() && ui.studio.is_saved();
  const std::string of_values = command_of_values(document, choice);
  const std::string of_session = is_saved ? command_of_session(document, ui.studio.file(), choice) : "";
  draw_command(ui, "The command line that makes the same:", "command", of_values);
  draw_command(ui, of_values.empty() ? "The command line that makes the same:" : "Or from the saved session:",
               "session-command", of_session);
  if (!is_saved && of_values.empty() && ui.state.export_kind != ExportKind::Report)
    ImGui::TextDisabled("Save the session first to have a command line that makes the same.");
}

}  // namespace

void draw_export_dialog(Ui& ui) {
  draw_kinds(ui);
  if (ui.state.export_kind == ExportKind::Layers) draw_layers_choice(ui);
  draw_commands(ui);
  ImGui::Spacing();
  const View& view = ui.studio.view;
  draw_file_dialog(
      ui, "Export",
      [&] {
        return ui.studio.export_as(ui.state.export_kind, ui.state.path, static_cast<LayersBy>(ui.state.export_layers));
      },
      [&] { return would_replace(ui.state.export_kind, ui.state.path, view.first_frame, view.last_frame); });
}

}  // namespace contrejour::studio
