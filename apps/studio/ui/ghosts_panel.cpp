// SPDX-License-Identifier: Apache-2.0
// The ghosts of the selected light: sorted, alone or muted, selected.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "studio/core/ghost_edits.h"
#include "studio/core/ghost_order.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr std::size_t kThatMatter = 10;

// The rows to show: those that the filter names ("3-8", or "8" for all that reflect there), in the order asked for.
std::vector<std::size_t> rows_of(const Ui& ui) {
  const auto& figures = ui.studio.figures();
  std::vector<std::size_t> rows;
  const std::string& filter = ui.state.ghost_filter;
  for (const std::size_t k : ghosts_in_order(figures, ui.state.ghost_order, ui.studio.frame_px())) {
    const std::string name = ghost_name(figures[k].ghost);
    const bool by_surface = !filter.empty() && filter.find('-') == std::string::npos &&
                            std::all_of(filter.begin(), filter.end(), [](char c) { return c >= '0' && c <= '9'; });
    const bool fits = by_surface ? figures[k].ghost.reflects_at(std::atoi(filter.c_str())) : name.starts_with(filter);
    if (fits) rows.push_back(k);
  }
  return rows;
}

void draw_summary(const Ui& ui) {
  const auto& figures = ui.studio.figures();
  const auto sum = [&](std::size_t count) {
    double flux = 0;
    for (std::size_t k = 0; k < std::min(count, figures.size()); ++k) flux += figures[k].relative_flux;
    return flux;
  };
  const double all = sum(figures.size());
  const std::string text =
      figures.empty() ? "measuring\u2026"
                      : fmt::format("{} ghosts carry {:.2f} % of the light; the ten brightest {:.0f} % of that",
                                    figures.size(), 100 * all, all > 0 ? 100 * sum(kThatMatter) / all : 0.0);
  fitting_text(text, ImGui::GetContentRegionAvail().x,
               ui.studio.figures_are_current() ? colours::kDim : colours::kAccentDim);
}

void draw_ghost_controls(Ui& ui) {
  ImGui::SetNextItemWidth(scaled(128));
  ImGui::InputTextWithHint("##filter", "3-8, or a surface", &ui.state.ghost_filter);
  ui.registry.record("ghosts/filter", ui.state.ghost_filter);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(scaled(112));
  if (ImGui::BeginCombo("##order", name_of(ui.state.ghost_order))) {
    for (const GhostOrder order : kGhostOrders) {
      if (ImGui::Selectable(name_of(order), order == ui.state.ghost_order)) ui.state.ghost_order = order;
      ui.registry.record(fmt::format("ghosts/order/{}", name_of(order)));
    }
    ImGui::EndCombo();
  }
  ui.registry.record("ghosts/order", name_of(ui.state.ghost_order));
  tip("By visibility: mean brightness times diameter, inside the frame. By flux: all light of the ghost. By peak: its "
      "brightest pixel.");
  ImGui::SameLine();
  if (button(ui, "ghosts/all", "Show all", "No ghost alone, none muted, all at their own gain (A)"))
    ui.studio.edit("show all ghosts", "", [](const Document& d) { return Result<Document>(with_all_ghosts(d)); });
}

void draw_switches(Ui& ui, const Ghost& ghost, const std::string& id) {
  const Document& document = ui.studio.document();
  const bool solo = is_solo(document, ghost), muted = is_muted(document, ghost);
  const std::string name = ghost_name(ghost);
  if (toggle(ui, id + "/solo", "S", solo, colours::kAccent, "Alone: only ghosts that are alone are drawn (S)"))
    ui.studio.edit((solo ? "end solo of ghost " : "solo ghost ") + name, "",
                   [&](const Document& d) { return with_solo(d, ghost, !solo); });
  ImGui::SameLine(0, scaled(3));
  if (toggle(ui, id + "/mute", "M", muted, colours::kBad, "Muted: not drawn (M)"))
    ui.studio.edit((muted ? "unmute ghost " : "mute ghost ") + name, "",
                   [&](const Document& d) { return with_mute(d, ghost, !muted); });
}

void draw_gain(Ui& ui, const Ghost& ghost, const std::string& id) {
  auto gain = static_cast<float>(adjustment_of(ui.studio.document(), ghost).gain);
  ImGui::PushID(id.c_str());
  ImGui::SetNextItemWidth(-1);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(scaled(4), 0));
  if (ImGui::DragFloat("##gain", &gain, 0.01F, 0, 1000, "%.3g"))
    ui.studio.edit(fmt::format("gain of ghost {}", ghost_name(ghost)), id + "/gain",
                   [&](const Document& d) { return with_gain(d, ghost, std::fmax(0.0, static_cast<double>(gain))); });
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ImGui::PopStyleVar();
  ImGui::PopID();
  ui.registry.record(id + "/gain", fmt::format("{}", gain));
  tip("Gain; 1 is physically right. Drag, or Ctrl+click to type.");
}

void draw_ghost_row(Ui& ui, std::size_t rank, const GhostFigures& figures) {
  const std::string id = "ghosts/" + ghost_name(figures.ghost);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool selected = ui.studio.selection.ghost == figures.ghost;
  ImGui::PushID(id.c_str());
  if (ImGui::Selectable(fmt::format("{}", rank + 1).c_str(), selected,
                        ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
    ui.studio.select_ghost(selected ? std::nullopt : std::optional<Ghost>(figures.ghost));
  ImGui::PopID();
  ui.registry.record(id, selected ? "selected" : "");
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(ghost_name(figures.ghost).c_str());
  ImGui::TableNextColumn();
  const double brightest = std::fmax(1e-30, std::fmax(figures.rgb[0], std::fmax(figures.rgb[1], figures.rgb[2])));
  colour_patch(display_colour(figures.rgb, brightest), scaled(18));
  ImGui::TableNextColumn();
  ImGui::Text("%.2g", 100 * figures.relative_flux);
  ImGui::TableNextColumn();
  ImGui::Text("%.2g", figures.peak_irradiance);
  ImGui::TableNextColumn();
  ImGui::Text("%.0f%s", std::fmax(figures.size_px.x, figures.size_px.y), figures.in_focus ? " f" : "");
  ImGui::TableNextColumn();
  draw_switches(ui, figures.ghost, id);
  ImGui::TableNextColumn();
  draw_gain(ui, figures.ghost, id);
}

void set_up_ghost_columns() {
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("#", ImGuiTableColumnFlags_WidthFixed, scaled(26));
  ImGui::TableSetupColumn("Ghost", ImGuiTableColumnFlags_WidthFixed, scaled(52));
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, scaled(18));
  ImGui::TableSetupColumn("Flux %", ImGuiTableColumnFlags_WidthStretch, 1);
  const bool is_narrow = ImGui::GetContentRegionAvail().x < scaled(400);
  ImGui::TableSetupColumn("Peak", ImGuiTableColumnFlags_WidthStretch | (is_narrow ? ImGuiTableColumnFlags_Disabled : 0),
                          1);
  ImGui::TableSetupColumn("Size px", ImGuiTableColumnFlags_WidthStretch, 0.9F);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, scaled(44));
  ImGui::TableSetupColumn("Gain", ImGuiTableColumnFlags_WidthFixed, scaled(46));
  ImGui::TableHeadersRow();
}

}  // namespace

void draw_ghosts_panel(Ui& ui) {
  draw_ghost_controls(ui);
  draw_summary(ui);
  constexpr ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH;
  if (!ImGui::BeginTable("ghosts", 8, flags)) return;
  set_up_ghost_columns();
  const auto rows = rows_of(ui);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()));
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k)
      draw_ghost_row(ui, static_cast<std::size_t>(k), ui.studio.figures()[rows[static_cast<std::size_t>(k)]]);
  ImGui::EndTable();
}

}  // namespace contrejour::studio
