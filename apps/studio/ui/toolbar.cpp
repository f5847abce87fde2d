// SPDX-License-Identifier: Apache-2.0
// The bar at the top: lens and look, aperture and focal length, undo, files.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

std::vector<ListedLens> listed_lenses() {
  std::vector<ListedLens> listed;
  for (const BundledLens& bundled : bundled_lenses()) {
    const std::string name(bundled.name);
    const auto lens = find_lens(name);
    listed.push_back({name, lens ? lens->name : name});
  }
  const auto in_lower_case = [](const ListedLens& lens) {
    std::string name = lens.full_name;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
  };
  std::ranges::sort(listed, {}, in_lower_case);
  return listed;
}

void draw_bundled_lens(Ui& ui, const ListedLens& lens, float second_column) {
  const bool chosen = lens.name == ui.studio.document().lens_name;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::Selectable(fmt::format("{}##{}", lens.full_name, lens.name).c_str(), chosen)) {
    ui.studio.open_lens(lens.name);
    ui.state.lens_filter.clear();
  }
  ui.registry.record(fmt::format("toolbar/lens/{}", lens.name), lens.full_name);
  ImGui::GetWindowDrawList()->AddText({at.x + second_column, at.y}, colours::dim(), lens.name.c_str());
}

// All lenses of which either name has the text that is typed; Enter takes the first.
void draw_lens_list(Ui& ui) {
  if (ImGui::IsWindowAppearing()) {
    if (ui.state.lenses.empty()) ui.state.lenses = listed_lenses();
    ui.state.lens_filter.clear();
    ImGui::SetKeyboardFocusHere();
  }
  float longest = 0, longest_second = 0;
  for (const ListedLens& lens : ui.state.lenses) {
    longest = std::max(longest, text_width(lens.full_name));
    longest_second = std::max(longest_second, text_width(lens.name));
  }
  const float second = longest + scaled(18);
  ImGui::SetNextItemWidth(second + longest_second + scaled(8));
  const bool entered =
      ImGui::InputTextWithHint("##find", "Find a lens", &ui.state.lens_filter, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.registry.record("toolbar/lens/find", ui.state.lens_filter);
  bool is_taken = false, is_empty = true;
  for (const ListedLens& lens : ui.state.lenses) {
    if (!contains_in_any_case(lens.full_name, ui.state.lens_filter) &&
        !contains_in_any_case(lens.name, ui.state.lens_filter))
      continue;
    if (entered && !is_taken && !ui.state.lens_filter.empty()) is_taken = ui.studio.open_lens(lens.name);
    draw_bundled_lens(ui, lens, second);
    is_empty = false;
  }
  if (is_empty) ImGui::TextDisabled("No bundled lens has this in its name.");
  if (is_taken) ImGui::CloseCurrentPopup();
}

void draw_lens_choice(Ui& ui) {
  const Document& document = ui.studio.document();
  const std::string shown =
      (document.lens->name.empty() ? document.lens_name : document.lens->name) + (document.lens_was_edited ? " *" : "");
  const float width = scaled(230);
  ImGui::SetNextItemWidth(width);
  const bool open = ImGui::BeginCombo("##lens", fitted(shown, width - 2 * ImGui::GetFrameHeight()).c_str(),
                                      ImGuiComboFlags_HeightLarge);
  ui.registry.record("toolbar/lens", document.lens_name);
  if (!open) {
    tip(fmt::format("{}\nThe lens: a bundled one, or a file of another program", shown).c_str());
    return;
  }
  draw_lens_list(ui);
  ImGui::Separator();
  if (ImGui::Selectable("Open a lens file\u2026")) open_dialog(ui, Dialog::OpenLens);
  ImGui::EndCombo();
}

// Dragged in parts of its value: the same way for half a stop anywhere.
void draw_lens_number(Ui& ui, const char* id, const char* name, const char* format, double now, double low,
                      double high) {
  auto value = static_cast<float>(now);
  ImGui::PushID(id);
  ImGui::SetNextItemWidth(scaled(84));
  if (ImGui::DragFloat("##number", &value, 0.004F * value, static_cast<float>(low), static_cast<float>(high), format,
                       ImGuiSliderFlags_AlwaysClamp))
    ui.studio.edit(fmt::format("set {}", name), fmt::format("parameter/{}", name),
                   [&](const Document& d) { return with_value(d, name, fmt::format("{:.4g}", value)); });
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ImGui::PopID();
  ui.registry.record(fmt::format("toolbar/{}", name), fmt::format("{}", value));
}

void draw_lens_numbers(Ui& ui) {
  const Prescription& lens = *ui.studio.document().lens;
  const double widest = lens.f_number > 0 ? lens.f_number : 0.5;
  draw_lens_number(ui, "f", "fnumber", "f/%.3g", ui.studio.lens().f_number, widest, 64);
  tip("The f-number. Drag, or click to type.");
  if (lens.zoom.size() < 2) return;
  ImGui::SameLine();
  draw_lens_number(ui, "zoom", "focal", "%.4g mm", ui.studio.lens().focal_length_mm, lens.zoom.front().focal_length_mm,
                   lens.zoom.back().focal_length_mm);
  tip("The focal length. Drag, or click to type.");
}

void draw_history_buttons(Ui& ui) {
  const History& history = ui.studio.history();
  const auto named = [&](bool can, std::size_t step, const char* nothing) {
    return can ? history.steps()[step].name : std::string(nothing);
  };
  const std::string undo = "Undo " + named(history.can_undo(), history.position(), "(nothing)") + "  (Ctrl+Z)";
  const std::string redo =
      "Redo " + named(history.can_redo(), history.position() + 1, "(nothing)") + "  (Ctrl+Shift+Z)";
  const auto step_button = [&](const char* id, const char* label, const std::string& help, bool is_possible) {
    ImGui::BeginDisabled(!is_possible);
    const bool pressed = button(ui, id, label);
    ImGui::EndDisabled();
    tip(help.c_str());
    return pressed;
  };
  if (step_button("toolbar/undo", "Undo", undo, history.can_undo())) ui.studio.undo();
  ImGui::SameLine();
  if (step_button("toolbar/redo", "Redo", redo, history.can_redo())) ui.studio.redo();
}

}  // namespace

void draw_toolbar(Ui& ui) {
  draw_lens_choice(ui);
  ImGui::SameLine(0, scaled(18));
  draw_lens_numbers(ui);
  ImGui::SameLine(0, scaled(18));
  draw_history_buttons(ui);
  align_right({"Plate", "Open", "Save", "Export", "?"});
  if (button(ui, "toolbar/plate", "Plate", "A photograph to which the flare is added"))
    open_dialog(ui, Dialog::OpenPlate);
  ImGui::SameLine();
  if (button(ui, "toolbar/open", "Open", "A session or a lens file (Ctrl+O)")) open_dialog(ui, Dialog::OpenLens);
  ImGui::SameLine();
  if (button(ui, "toolbar/save", "Save", "The session (Ctrl+S)")) open_dialog(ui, Dialog::SaveAs, ui.studio.file());
  ImGui::SameLine();
  ImGui::PushStyleColor(ImGuiCol_Button, colours::kAccent);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, IM_COL32(250, 196, 118, 255));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, colours::kAccent);
  ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(24, 22, 18, 255));
  const bool exports = button(ui, "toolbar/export", "Export");
  ImGui::PopStyleColor(4);
  tip("The picture, its layers, frames, the lens, a look, a report (Ctrl+E)");
  if (exports) open_dialog(ui, Dialog::Export, file_to_export(ui));
  ImGui::SameLine();
  if (button(ui, "toolbar/help", "?", "All keys (F1)")) ui.state.shows_help = !ui.state.shows_help;
}

}  // namespace contrejour::studio
