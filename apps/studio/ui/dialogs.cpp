// SPDX-License-Identifier: Apache-2.0
// Dialogs: files to open and to save, recovery, unsaved changes.
#include <algorithm>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "contrejour/expert/flare_source.h"
#include "studio/core/file_choice.h"
#include "studio/core/plate_frames.h"
#include "studio/ui/file_dialog.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

bool is_bundled(const std::string& name) {
  const auto lenses = bundled_lenses();
  return std::any_of(lenses.begin(), lenses.end(), [&](const BundledLens& lens) { return lens.name == name; });
}

bool open_file(Ui& ui) {
  if (is_measured_flare(ui.state.path)) {
    ui.studio.open_measured(ui.state.path);
    ui.state.bottom = BottomTab::Measured;
    ui.state.bottom_was_chosen = true;
    return true;
  }
  if (is_session(ui.state.path)) return ui.studio.open_session(ui.state.path);
  // The name of a bundled lens may be typed behind the folder that the dialog offers.
  const std::filesystem::path path(ui.state.path);
  std::error_code code;
  const bool is_name = !std::filesystem::exists(path, code) && is_bundled(path.filename().string());
  return ui.studio.open_lens(is_name ? path.filename().string() : ui.state.path);
}

// A file in the folder stands for it.
bool open_sweep(Ui& ui) {
  ui.studio.open_measured_sweep(folder_of(ui.state.path).lexically_normal().string());
  return true;
}

std::string session_name(const std::string& path) { return is_session(path) ? path : path + ".session.json"; }

bool save_file(Ui& ui) {
  ui.state.path = session_name(ui.state.path);
  if (!ui.studio.save_session(ui.state.path)) return false;
  ui.state.wants_to_quit = ui.state.quits_when_saved;
  return true;
}

// The session's own file is replaced without asking.
bool replaces_session(const Ui& ui) {
  std::error_code code;
  const std::string file = session_name(ui.state.path);
  return file != ui.studio.file() && std::filesystem::exists(file, code);
}

void draw_recovery(Ui& ui) {
  ImGui::TextUnformatted("The studio ended before this work was saved:");
  for (std::size_t k = 0; k < ui.state.lost.size(); ++k) {
    const LostWork& work = ui.state.lost[k];
    ImGui::Spacing();
    ImGui::PushID(static_cast<int>(k));
    ImGui::Text("%s, %s, %lld min ago", work.lens.c_str(), work.of_file.empty() ? "never saved" : work.of_file.c_str(),
                static_cast<long long>(work.age.count() / 60));
    const bool recovers = button(ui, fmt::format("recover/{}", k + 1), "Recover");
    ImGui::SameLine();
    const bool discards = button(ui, fmt::format("recover/{}/discard", k + 1), "Discard");
    ImGui::PopID();
    if (recovers && !ui.studio.recover(work)) continue;
    if (discards) Autosave::remove(work);
    if (recovers || discards) ui.state.lost.erase(ui.state.lost.begin() + static_cast<std::ptrdiff_t>(k));
    if (recovers || ui.state.lost.empty()) ImGui::CloseCurrentPopup();
    if (recovers || discards) break;
  }
  ImGui::Spacing();
  if (button(ui, "recover/later", "Not now", "The copies stay, and are offered again")) ImGui::CloseCurrentPopup();
}

void draw_quit(Ui& ui) {
  ImGui::TextUnformatted("This session has changes that are not saved.");
  ImGui::Spacing();
  if (button(ui, "quit/save", "Save", nullptr, {scaled(110), 0})) {
    ImGui::CloseCurrentPopup();
    open_dialog(ui, Dialog::SaveAs, ui.studio.file());
    ui.state.quits_when_saved = true;
  }
  ImGui::SameLine();
  if (button(ui, "quit/discard", "Discard", nullptr, {scaled(110), 0})) {
    ui.studio.forget_autosave();
    ui.state.wants_to_quit = true;
  }
  ImGui::SameLine();
  if (button(ui, "quit/cancel", "Cancel", nullptr, {scaled(110), 0})) ImGui::CloseCurrentPopup();
}

// Takes the whole sequence that the file chosen is a frame of.
void draw_sequence_choice(Ui& ui) {
  const auto sequence = sequence_of_file(ui.state.path);
  ImGui::BeginDisabled(!sequence);
  const std::string label =
      fmt::format("Take the sequence {}", sequence ? std::filesystem::path(*sequence).filename().string() : "");
  if (button(ui, "dialog/sequence", label.c_str())) ui.state.path = *sequence;
  ImGui::EndDisabled();
}

void draw_plate_choice(Ui& ui) {
  draw_sequence_choice(ui);
  draw_file_dialog(ui, "Open", [&] { return ui.studio.open_plate(ui.state.path); });
}

void draw_content(Ui& ui) {
  switch (ui.state.dialog) {
    case Dialog::OpenLens: return draw_file_dialog(ui, "Open", [&] { return open_file(ui); });
    case Dialog::OpenPlate: return draw_plate_choice(ui);
    case Dialog::OpenSweep: return draw_file_dialog(ui, "Open", [&] { return open_sweep(ui); });
    case Dialog::SaveAs:
      return draw_file_dialog(ui, "Save", [&] { return save_file(ui); }, [&] { return replaces_session(ui); });
    case Dialog::Export: return draw_export_dialog(ui);
    case Dialog::Recover: return draw_recovery(ui);
    case Dialog::Quit: return draw_quit(ui);
    case Dialog::None: return;
  }
}

const char* title_of(Dialog dialog) {
  static constexpr const char* titles[] = {"",
                                           "Open a lens or a session",
                                           "Open a plate",
                                           "Open the folder of merged photographs",
                                           "Save the session",
                                           "Export",
                                           "Recover unsaved work",
                                           "Unsaved changes"};
  return titles[static_cast<std::size_t>(dialog)];
}

}  // namespace

void draw_file_dialog(Ui& ui, const char* action, const std::function<bool()>& act,
                      const std::function<bool()>& replaces) {
  const Dialog dialog = ui.state.dialog;
  const bool entered = draw_path_field(ui);
  draw_folder(ui);
  if (ui.state.dialog_has_failed && !ui.studio.problem().empty()) {
    ImGui::PushTextWrapPos(scaled(560));
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(colours::kBad), "%s", ui.studio.problem().c_str());
    ImGui::PopTextWrapPos();
  }
  if (ui.state.asked_path != ui.state.path) ui.state.asked_path.clear();
  const bool was_asked = !ui.state.asked_path.empty();
  if (was_asked) ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(colours::kAccent), "This file exists. Replace it?");
  const bool acts = button(ui, "dialog/accept", was_asked ? "Replace" : action, nullptr, {scaled(110), 0}) || entered;
  ImGui::SameLine();
  if (button(ui, "dialog/cancel", "Cancel", nullptr, {scaled(110), 0})) ImGui::CloseCurrentPopup();
  if (!acts || ui.state.path.empty() || lists_folder_typed(ui)) return;
  if (!was_asked && replaces && replaces()) {
    ui.state.asked_path = ui.state.path;
    return;
  }
  ui.state.asked_path.clear();
  ui.state.dialog_has_failed = !act();
  if (ui.state.dialog_has_failed) return;
  remember_folder(ui, dialog);
  ImGui::CloseCurrentPopup();
}

void draw_dialogs(Ui& ui) {
  if (ui.state.dialog == Dialog::None) return;
  const std::string title = fmt::format("{}##dialog", title_of(ui.state.dialog));
  if (ui.state.dialog_opens) ImGui::OpenPopup(title.c_str());
  ui.state.dialog_opens = false;
  const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5F, 0.5F});
  const Dialog shown = ui.state.dialog;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  if (!ImGui::BeginPopupModal(title.c_str(), nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) {
    ImGui::PopStyleVar();
    ui.state.dialog = Dialog::None;
    return;
  }
  ImGui::PopStyleVar();
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
  draw_content(ui);
  ImGui::EndPopup();
  if (ui.state.dialog == shown && !ImGui::IsPopupOpen(title.c_str())) ui.state.dialog = Dialog::None;
}

}  // namespace contrejour::studio
