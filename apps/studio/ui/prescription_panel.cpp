// SPDX-License-Identifier: Apache-2.0
// The prescription as a table that one can type in.
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

void draw_glass_completion(Ui& ui, const std::string& id) {
  const TextEdit& edit = ui.state.edit;
  if (edit.id != id || edit.text.empty()) return;
  const auto names = glasses_like(edit.text, 8);
  if (names.empty()) return;
  ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y + scaled(2)});
  ImGui::BeginTooltip();
  for (const std::string& name : names) ImGui::TextUnformatted(name.c_str());
  ImGui::EndTooltip();
}

void draw_cell(Ui& ui, std::size_t row, LensColumn column) {
  const Prescription& lens = *ui.studio.document().lens;
  ImGui::TableNextColumn();
  if (!is_editable(lens, row, column)) return;
  const std::string id = fmt::format("prescription/{}/{}", row + 1, short_name(column));
  const bool is_coating = column == LensColumn::Coating;
  const int number = static_cast<int>(row) + 1;
  // The coating in force: values of the document come before the lens's own.
  std::string text = is_coating ? coating_of_surface(ui.studio.document(), number) : cell_text(lens, row, column);
  const std::string before = text;
  const bool accepted = text_field(ui, id, text, -1);
  if (column == LensColumn::Glass) draw_glass_completion(ui, id);
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

void draw_actions(Ui& ui) {
  const auto row = static_cast<std::size_t>(std::max(0, ui.studio.selection.surface - 1));
  const bool has_row = ui.studio.selection.surface > 0;
  const std::size_t count = ui.studio.document().lens->surfaces.size();
  if (button(ui, "prescription/insert", "Insert", "A surface in the middle of the gap behind the selected one") &&
      has_row)
    edit_surfaces(ui, "insert a surface", numbers_after_insertion(count, row),
                  [&](const Prescription& p) { return with_inserted_surface(p, row); });
  ImGui::SameLine();
  if (button(ui, "prescription/delete", "Delete", "The selected surface") && has_row)
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
               colours::kDim);
}

void set_up_lens_columns() {
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("#", ImGuiTableColumnFlags_WidthFixed, scaled(28));
  ImGui::TableSetupColumn("Type", ImGuiTableColumnFlags_WidthFixed, scaled(54));
  for (const LensColumn column : kLensColumns)
    ImGui::TableSetupColumn(std::string(heading_of(column)).c_str(), ImGuiTableColumnFlags_WidthStretch,
                            column == LensColumn::Coating ? 1.4F
                            : column == LensColumn::Conic ? 0.7F
                                                          : 1.0F);
  ImGui::TableSetupColumn("n / V", ImGuiTableColumnFlags_WidthFixed, scaled(96));
  ImGui::TableHeadersRow();
}

}  // namespace

void draw_prescription_panel(Ui& ui) {
  draw_actions(ui);
  constexpr ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH;
  if (!ImGui::BeginTable("prescription", 9, flags)) return;
  set_up_lens_columns();
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(0, 0, 0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(scaled(4), scaled(1)));
  const std::size_t count = ui.studio.document().lens->surfaces.size();
  for (std::size_t row = 0; row < count && row < ui.studio.document().lens->surfaces.size(); ++row)
    draw_lens_row(ui, row);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  ImGui::EndTable();
}

}  // namespace contrejour::studio
