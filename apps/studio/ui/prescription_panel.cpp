// SPDX-License-Identifier: Apache-2.0
// The prescription as a table that one can type in.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/parameter_text.h"
#include "studio/core/coating_curves.h"
#include "studio/core/prescription_table.h"
#include "studio/core/surface_numbers.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

using LensEdit = std::function<Result<Prescription>(const Prescription&)>;

bool edit_lens(Ui& ui, const std::string& name, const LensEdit& edit) {
  return ui.studio.edit(name, "prescription", [&](const Document& d) -> Result<Document> {
    auto lens = edit(*d.lens);
    if (!lens) return tl::unexpected(lens.error());
    return with_edited_lens(d, std::move(*lens));
  });
}

// An edit after which surfaces have other numbers: a step of its own.
void edit_surfaces(Ui& ui, const std::string& name, const SurfaceNumbers& numbers, const LensEdit& edit) {
  ui.studio.edit(name, "", [&](const Document& d) -> Result<Document> {
    auto lens = edit(*d.lens);
    if (!lens) return tl::unexpected(lens.error());
    return with_edited_lens(with_surface_numbers(d, numbers), std::move(*lens));
  });
}

std::string_view short_name(LensColumn column) {
  constexpr std::string_view names[] = {"radius", "thickness", "glass", "semi-diameter", "conic", "coating"};
  return names[static_cast<std::size_t>(column)];
}

std::string completed_glass(const std::string& text) {
  const auto names = glasses_like(text, 1);
  return names.empty() || text.empty() ? text : names.front();
}

// The names of a list of completions are taken by a click, which also ends the typing: the field is left in the same
// frame, so that the name under the mouse is the one that the list had in the frame before.
void draw_glass_completion(Ui& ui, const std::string& id) {
  TextEdit& edit = ui.state.edit;
  if (edit.id != id) return;
  edit.offered.clear();
  const auto names = edit.text.empty() ? std::vector<std::string>{} : glasses_near(edit.text, 8);
  if (names.empty()) return;
  const bool tab_completes = !glasses_like(edit.text, 1).empty() && names.front() != edit.text;
  begin_completions(names.size() + (tab_completes ? 1 : 0));
  for (const std::string& name : names) {
    if (completion(name)) edit.offered = name;
    ui.registry.record(fmt::format("{}/completions/{}", id, name));
  }
  if (tab_completes) ImGui::TextDisabled("Tab takes the first");
  ImGui::End();
}

// The coating in force: values of the document come before the lens's own.
std::string text_of_cell(const Ui& ui, std::size_t row, LensColumn column) {
  const Prescription& lens = *ui.studio.document().lens;
  if (column != LensColumn::Coating || !is_editable(lens, row, column)) return cell_text(lens, row, column);
  return coating_of_surface(ui.studio.document(), static_cast<int>(row) + 1);
}

void draw_cell(Ui& ui, std::size_t row, LensColumn column) {
  const Prescription& lens = *ui.studio.document().lens;
  ImGui::TableNextColumn();
  if (!is_editable(lens, row, column)) return;
  const std::string id = fmt::format("prescription/{}/{}", row + 1, short_name(column));
  const bool is_coating = column == LensColumn::Coating;
  const int number = static_cast<int>(row) + 1;
  std::string text = text_of_cell(ui, row, column);
  const std::string before = text;
  const std::string offered = ui.state.edit.id == id && ImGui::IsMouseClicked(0) ? ui.state.edit.offered : "";
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool is_hovered =
      ImGui::IsWindowHovered() &&
      ImGui::IsMouseHoveringRect(at, {at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetFrameHeight()});
  if (is_hovered) ImGui::PushStyleColor(ImGuiCol_FrameBg, ImGui::GetStyleColorVec4(ImGuiCol_FrameBgHovered));
  bool accepted = text_field(ui, id, text, -1, "", column == LensColumn::Glass ? completed_glass : nullptr);
  if (is_hovered) ImGui::PopStyleColor();
  if (column == LensColumn::Glass) draw_glass_completion(ui, id);
  if (!offered.empty()) {
    text = offered;
    accepted = true;
  }
  if (!accepted || text == before) return;
  const std::string name = fmt::format("{} of surface {}", short_name(column), row + 1);
  ui.studio.end_gesture();
  const auto coat = [&](const Document& d) { return with_surface_coating(d, number, text.empty() ? "none" : text); };
  if (is_coating) {
    if (!ui.studio.edit(name, "", coat)) refuse_text(ui, id, text, ui.studio.problem());
    return;
  }
  if (!edit_lens(ui, name, [&](const Prescription& p) { return with_cell(p, row, column, text); }))
    refuse_text(ui, id, text, ui.studio.problem());
}

void draw_lens_row(Ui& ui, std::size_t row) {
  const Surface& surface = ui.studio.document().lens->surfaces[row];
  const int number = static_cast<int>(row) + 1;
  ImGui::TableNextRow();
  if (ui.studio.selection.surface == number)
    ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, ImGui::GetColorU32(ImGuiCol_Header));
  ImGui::TableNextColumn();
  const std::string id = fmt::format("prescription/{}", number);
  ImGui::AlignTextToFramePadding();
  if (ImGui::Selectable(fmt::format("{}##{}", number, id).c_str(), ui.studio.selection.surface == number))
    ui.studio.selection.surface = number;
  ui.registry.record(id, ui.studio.selection.surface == number ? "selected" : "");
  bring_into_sight(ui, number, ui.state.row_in_sight);
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", surface.kind == SurfaceKind::Stop ? "stop"
                            : surface.shape.is_sphere()       ? "sphere"
                                                              : "asphere");
  for (const LensColumn column : kLensColumns) draw_cell(ui, row, column);
  ImGui::TableNextColumn();
  const double index = refractive_index(surface.glass_after, kLineD_nm);
  if (!is_air(surface.glass_after) && surface.kind != SurfaceKind::Stop) {
    ImGui::AlignTextToFramePadding();
    const GlassFigures figures = glass_figures(surface.glass_after);
    ImGui::TextDisabled("%.4f / %.1f", index, figures.v_d);
  }
}

// A button that needs a selected surface; it says so where there is none.
bool surface_button(Ui& ui, const char* id, const char* label, const char* help) {
  const bool has_row = ui.studio.selection.surface > 0;
  ImGui::BeginDisabled(!has_row);
  const bool pressed = button(ui, id, label);
  ImGui::EndDisabled();
  tip(has_row ? help : "Select a surface first: click its number below, or the surface in the section (F2)");
  return pressed;
}

void draw_actions(Ui& ui) {
  const auto row = static_cast<std::size_t>(std::max(0, ui.studio.selection.surface - 1));
  const std::size_t count = ui.studio.document().lens->surfaces.size();
  if (surface_button(ui, "prescription/insert", "Insert", "A surface in the middle of the gap behind the selected one"))
    edit_surfaces(ui, "insert a surface", numbers_after_insertion(count, row),
                  [&](const Prescription& p) { return with_inserted_surface(p, row); });
  ImGui::SameLine();
  if (surface_button(ui, "prescription/delete", "Delete", "The selected surface"))
    edit_surfaces(ui, fmt::format("delete surface {}", row + 1), numbers_after_deletion(count, row),
                  [&](const Prescription& p) { return without_surface(p, row); });
  ImGui::SameLine();
  if (button(ui, "prescription/reverse", "Reverse", "Light passes the lens from the other end"))
    edit_surfaces(ui, "reverse the lens", numbers_after_reversal(count),
                  [](const Prescription& p) { return reversed_lens(p); });
  ImGui::SameLine();
  std::string factor;
  if (text_field(ui, "prescription/scale", factor, scaled(90), "scale by\u2026") && !factor.empty()) {
    const auto value = params::parse_real(factor);
    if (!value || !edit_lens(ui, "scale the lens", [&](const Prescription& p) { return scaled_lens(p, *value); }))
      refuse_text(ui, "prescription/scale", factor, value ? ui.studio.problem() : value.error().message);
  }
  ImGui::SameLine();
  const Document& document = ui.studio.document();
  fitting_text(document.lens->name + (document.lens_was_edited ? "  (edited)" : ""), ImGui::GetContentRegionAvail().x,
               colours::dim());
}

constexpr float kCellPadding = 4;  // of a field, at its left and right
constexpr std::size_t kColumns = kLensColumns.size() + 3;

// Each column is as wide as its longest text: a number that is cut looks like another number. What is left over is
// spread evenly; a table that is wider than its panel scrolls.
std::array<float, kColumns> column_widths(const Ui& ui) {
  const Prescription& lens = *ui.studio.document().lens;
  std::array<float, kColumns> widths = {scaled(28), text_width("asphere")};
  for (std::size_t c = 0; c < kLensColumns.size(); ++c) {
    float& width = widths[c + 2];
    width = std::max(text_width(std::string(heading_of(kLensColumns[c]))), scaled(48));
    for (std::size_t row = 0; row < lens.surfaces.size(); ++row)
      width = std::max(width, text_width(text_of_cell(ui, row, kLensColumns[c])) + 2 * scaled(kCellPadding) + 2);
  }
  widths.back() = text_width("1.8888 / 88.8");
  float all = ImGui::GetStyle().ScrollbarSize;
  for (const float width : widths) all += width + 2 * ImGui::GetStyle().CellPadding.x;
  const float left = std::max(0.0F, ImGui::GetContentRegionAvail().x - all) / static_cast<float>(kLensColumns.size());
  for (std::size_t c = 0; c < kLensColumns.size(); ++c) widths[c + 2] += std::floor(left);
  return widths;
}

void set_up_lens_columns(const Ui& ui) {
  ImGui::TableSetupScrollFreeze(1, 1);
  const auto widths = column_widths(ui);
  std::size_t column = 0;
  const auto add = [&](std::string_view heading) {
    ImGui::TableSetupColumn(std::string(heading).c_str(), ImGuiTableColumnFlags_WidthFixed, widths[column++]);
  };
  add("#");
  add("Type");
  for (const LensColumn c : kLensColumns) add(heading_of(c));
  add("n / V");
  heading_row({"The surface's number, from the front. A click selects it in all panels.", "Its shape, or the stop",
               "Of curvature at the vertex; inf: a plane. Above 0: its centre lies behind the surface.",
               "To the next surface", "Behind the surface, by its name in the catalogue or as n,V; empty: air",
               "Half of the diameter that lets light pass", "0: a sphere; -1: a paraboloid",
               "none, quarter-wave, v-coat:550, \u2026 The panel Coatings (F4) shows what it does.",
               "Refractive index and Abbe number of the glass behind the surface, at the d line"},
              2, static_cast<int>(kLensColumns.size()), scaled(kCellPadding));
}

}  // namespace

void draw_prescription_panel(Ui& ui) {
  draw_actions(ui);
  constexpr ImGuiTableFlags flags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                    ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingFixedFit;
  if (!ImGui::BeginTable("prescription", static_cast<int>(kColumns), flags)) return;
  set_up_lens_columns(ui);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(0, 0, 0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(scaled(kCellPadding), scaled(1)));
  const std::size_t count = ui.studio.document().lens->surfaces.size();
  for (std::size_t row = 0; row < count && row < ui.studio.document().lens->surfaces.size(); ++row)
    draw_lens_row(ui, row);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  ImGui::EndTable();
}

}  // namespace contrejour::studio
