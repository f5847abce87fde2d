// SPDX-License-Identifier: Apache-2.0
// The path and the folder of a file dialog.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/core/file_choice.h"
#include "studio/ui/file_dialog.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr float kFileWidth = 560;

FileKind kind_of(const Ui& ui) {
  if (ui.state.shows_all_files) return FileKind::Any;
  switch (ui.state.dialog) {
    case Dialog::OpenLens: return FileKind::Lens;
    case Dialog::OpenPlate:
    case Dialog::OpenSweep: return FileKind::Plate;
    case Dialog::SaveAs: return FileKind::Session;
    default: return FileKind::Any;
  }
}

// Selects the name behind the last slash, so that typing replaces the name and keeps the folder.
int select_name(ImGuiInputTextCallbackData* data) {
  auto& is_due = *static_cast<bool*>(data->UserData);
  if (!is_due) return 0;
  is_due = false;
  const std::size_t slash = std::string_view(data->Buf, static_cast<std::size_t>(data->BufTextLen)).rfind('/');
  data->SelectionStart = slash == std::string_view::npos ? 0 : static_cast<int>(slash) + 1;
  data->SelectionEnd = data->CursorPos = data->BufTextLen;
  return 0;
}

void go_to(Ui& ui, const std::string& folder) {
  ui.state.path = folder.ends_with('/') ? folder : folder + "/";
  ui.state.path_wants_keys = true;
}

}  // namespace

bool draw_path_field(Ui& ui) {
  ImGui::SetNextItemWidth(scaled(kFileWidth));
  if (ImGui::IsWindowAppearing() || ui.state.path_wants_keys) {
    ImGui::SetKeyboardFocusHere();
    ui.state.path_wants_keys = false;
    ui.state.selects_name = true;
  }
  constexpr ImGuiInputTextFlags flags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways;
  const bool entered = ImGui::InputText("##path", &ui.state.path, flags, select_name, &ui.state.selects_name);
  ui.registry.record("dialog/path", ui.state.path);
  return entered;
}

void draw_folder(Ui& ui) {
  const auto folder = folder_of(typed_path(ui.state.path));
  ImGui::TextDisabled("%s", fitted(folder.string(), scaled(kFileWidth)).c_str());
  const float room = ImGui::GetIO().DisplaySize.y - scaled(384);  // what is above and below it in the largest dialog
  ImGui::BeginChild("##folder", {scaled(kFileWidth), std::clamp(room, scaled(80), scaled(260))}, true,
                    ImGuiWindowFlags_AlwaysUseWindowPadding);
  const bool exports = ui.state.dialog == Dialog::Export && !ui.state.shows_all_files;
  const FolderListing listing =
      exports ? listing_of(folder, endings_of(ui.state.export_kind)) : listing_of(folder, kind_of(ui));
  if (ImGui::Selectable("..")) go_to(ui, folder.parent_path().string());
  for (const FolderEntry& entry : listing.entries) {
    const std::string label = entry.name + (entry.is_folder ? "/" : "");
    const bool chosen = ImGui::Selectable(label.c_str(), false, ImGuiSelectableFlags_DontClosePopups);
    ui.registry.record("folder/" + label);
    if (chosen && entry.is_folder) go_to(ui, (folder / entry.name).string());
    if (chosen && !entry.is_folder) ui.state.path = (folder / entry.name).string();
  }
  ImGui::EndChild();
  const std::string all = listing.others > 0 ? fmt::format("Show all files ({} more)###all", listing.others)
                                             : std::string("Show all files###all");
  ImGui::Checkbox(all.c_str(), &ui.state.shows_all_files);
  ui.registry.record("dialog/all-files", fmt::format("{}", listing.others));
}

bool lists_folder_typed(Ui& ui) {
  ui.state.path = typed_path(ui.state.path);
  std::error_code code;
  if (ui.state.dialog == Dialog::OpenSweep || !std::filesystem::is_directory(ui.state.path, code)) return false;
  go_to(ui, ui.state.path);
  if (ui.state.dialog == Dialog::SaveAs) ui.state.path += usual_session(ui.studio.document().lens_name);
  if (ui.state.dialog == Dialog::Export) ui.state.path += file_to_export(ui);
  return true;
}

std::string file_to_export(const Ui& ui) {
  const std::string& before = ui.state.exported[static_cast<std::size_t>(ui.state.export_kind)];
  return before.empty() ? usual_file(ui.state.export_kind) : before;
}

void remember_folder(Ui& ui, Dialog dialog) {
  const std::string folder = std::filesystem::path(ui.state.path).parent_path().string();
  if (dialog == Dialog::Export)
    ui.state.exported[static_cast<std::size_t>(ui.state.export_kind)] =
        std::filesystem::path(ui.state.path).filename().string();
  if (!folder.empty()) ui.state.folders[static_cast<std::size_t>(dialog)] = folder + (folder == "/" ? "" : "/");
}

void open_dialog(Ui& ui, Dialog dialog, std::string path) {
  ui.state.dialog = dialog;
  ui.state.dialog_opens = true;
  ui.state.dialog_has_failed = false;
  ui.state.quits_when_saved = false;
  if (dialog == Dialog::SaveAs && path.empty()) path = usual_session(ui.studio.document().lens_name);
  const bool has_folder = std::filesystem::path(path).has_parent_path();
  ui.state.path = (has_folder ? "" : ui.state.folders[static_cast<std::size_t>(dialog)]) + path;
}

}  // namespace contrejour::studio
