// SPDX-License-Identifier: Apache-2.0
// The bar at the top: lens and look, aperture and focal length, undo, files.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

void draw_lens_choice(Ui& ui) {
  const Document& document = ui.studio.document();
  const std::string shown =
      (document.lens->name.empty() ? document.lens_name : document.lens->name) + (document.lens_was_edited ? " *" : "");
  ImGui::SetNextItemWidth(scaled(230));
  const bool open = ImGui::BeginCombo("##lens", shown.c_str(), ImGuiComboFlags_HeightLarge);
  ui.registry.record("toolbar/lens", document.lens_name);
  if (!open) {
    tip("The lens; a bundled one, or a file of another program");
    return;
  }
  for (const BundledLens& lens : bundled_lenses()) {
    if (ImGui::Selectable(std::string(lens.name).c_str(), lens.name == document.lens_name))
      ui.studio.open_lens(std::string(lens.name));
    ui.registry.record(fmt::format("toolbar/lens/{}", lens.name));
  }
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
  tip("The f-number. Drag, or Ctrl+click to type.");
  if (lens.zoom.size() < 2) return;
  ImGui::SameLine();
  draw_lens_number(ui, "zoom", "focal", "%.4g mm", ui.studio.lens().focal_length_mm, lens.zoom.front().focal_length_mm,
                   lens.zoom.back().focal_length_mm);
  tip("The focal length. Drag, or Ctrl+click to type.");
}

void draw_history_buttons(Ui& ui) {
  const History& history = ui.studio.history();
  const auto named = [&](bool can, std::size_t step, const char* nothing) {
    return can ? history.steps()[step].name : std::string(nothing);
  };
  const std::string undo = "Undo " + named(history.can_undo(), history.position(), "(nothing)") + "  (Ctrl+Z)";
  const std::string redo =
      "Redo " + named(history.can_redo(), history.position() + 1, "(nothing)") + "  (Ctrl+Shift+Z)";
  if (button(ui, "toolbar/undo", "Undo", undo.c_str())) ui.studio.undo();
  ImGui::SameLine();
  if (button(ui, "toolbar/redo", "Redo", redo.c_str())) ui.studio.redo();
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
  const bool exports =
      button(ui, "toolbar/export", "Export", "The picture, its layers, frames, the lens, a look, a report (Ctrl+E)");
  ImGui::PopStyleColor(4);
  if (exports) open_dialog(ui, Dialog::Export, usual_file(ui.state.export_kind));
  ImGui::SameLine();
  if (button(ui, "toolbar/help", "?", "All keys (F1)")) ui.state.shows_help = !ui.state.shows_help;
}

}  // namespace contrejour::studio
