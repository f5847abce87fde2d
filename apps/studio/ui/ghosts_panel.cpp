// SPDX-License-Identifier: Apache-2.0
// The ghosts of the selected light: sorted, alone or muted, selected.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/core/ghost_edits.h"
#include "studio/core/ghost_order.h"
#include "studio/core/ghost_summary.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

// A row to show: its place in the order asked for, whether the filter hides others or not, and its figures.
struct GhostRow {
  std::size_t rank, figures;
};

// The ghosts that the filter names ("3-8", or "8" for all that reflect there), in the order asked for.
std::vector<GhostRow> rows_of(const Ui& ui) {
  const auto& figures = ui.studio.figures();
  std::vector<GhostRow> rows;
  const std::string& filter = ui.state.ghost_filter;
  const bool by_surface =
      !filter.empty() && std::all_of(filter.begin(), filter.end(), [](char c) { return c >= '0' && c <= '9'; });
  std::size_t rank = 0;
  for (const std::size_t k : ghosts_in_order(figures, ui.state.ghost_order, ui.studio.frame_px())) {
    ++rank;
    const Ghost& ghost = figures[k].ghost;
    if (by_surface ? ghost.reflects_at(std::atoi(filter.c_str())) : ghost_name(ghost).starts_with(filter))
      rows.push_back({rank, k});
  }
  return rows;
}

void draw_summary(Ui& ui, std::size_t listed) {
  const std::string text =
      summary_of_ghosts(ui.studio.document(), ui.studio.figures(), ui.studio.selection.light, listed);
  fitting_text(text, ImGui::GetContentRegionAvail().x,
               ui.studio.figures_are_current() ? colours::dim() : colours::kAccentDim);
  ui.registry.record("ghosts/summary", text);
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
  if (button(ui, "ghosts/all", "Show all", "No ghost solo, none muted, all at their own gain (A)"))
    ui.studio.edit("show all ghosts", "", [](const Document& d) { return Result<Document>(with_all_ghosts(d)); });
}

void draw_switches(Ui& ui, const Ghost& ghost, const std::string& id) {
  const Document& document = ui.studio.document();
  const bool solo = is_solo(document, ghost), muted = is_muted(document, ghost);
  const std::string name = ghost_name(ghost);
  if (toggle(ui, id + "/solo", "S", solo, colours::kAccent, "Solo: every ghost that is not solo is hidden (S)"))
    ui.studio.edit((solo ? "end solo of ghost " : "solo ghost ") + name, "",
                   [&](const Document& d) { return with_solo(d, ghost, !solo); });
  ImGui::SameLine(0, scaled(3));
  if (toggle(ui, id + "/mute", "M", muted, colours::kBad, "Mute: this ghost is hidden (M)"))
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
  tip("Gain; 1 is physically right. Drag, or click to type.");
}

constexpr double kLeastFlux_percent = 1e-4;  // smaller figures would need powers of ten

std::string flux_text(const GhostFigures& figures) {
  const double percent = 100 * figures.relative_flux;
  return percent < kLeastFlux_percent ? "<0.0001" : fmt::format("{:.4f}", percent);
}

double largest_peak(const Ui& ui) {
  double peak = 0;
  for (const GhostFigures& f : ui.studio.figures()) peak = std::fmax(peak, f.peak_irradiance);
  return peak;
}

std::string peak_text(const GhostFigures& figures, double largest) {
  return figures.peak_irradiance > 0 ? fmt::format("{:.1f}", std::log2(figures.peak_irradiance / largest)) : "\u2013";
}

std::string size_text(const Ui& ui, const GhostFigures& figures) {
  const double size = std::fmax(figures.size_px.x, figures.size_px.y);
  const auto frame = params::parse_size(ui.studio.document().text("size"));
  const double width = frame ? frame->width : 1920;
  if (size > 9.95 * width) return ">10 frames";
  if (size > width) return fmt::format("{:.1f} frames", size / width);
  return fmt::format("{:.0f}{}", size, figures.in_focus ? " sharp" : "");
}

void draw_ghost_figures(const Ui& ui, const GhostFigures& figures, double largest) {
  const std::string all = fmt::format(
      "{:.3g} % of the light; its brightest pixel has {:.3g} of the irradiance at the lens; {:.0f} x {:.0f} px{}",
      100 * figures.relative_flux, figures.peak_irradiance, figures.size_px.x, figures.size_px.y,
      figures.in_focus ? "; sharp: in focus for a light on the axis" : "");
  for (const std::string& text : {flux_text(figures), peak_text(figures, largest), size_text(ui, figures)}) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
    tip(all.c_str());
  }
}

// Its rays miss the sensor: it has no figures.
void draw_absence() {
  for (int column = 0; column < 3; ++column) {
    ImGui::TableNextColumn();
    ImGui::TextDisabled("\u2013");
    tip("None of its light reaches the picture");
  }
}

void draw_ghost_row(Ui& ui, const GhostRow& row, double largest) {
  const auto& [rank, index] = row;
  const GhostFigures& figures = ui.studio.figures()[index];
  const std::string id = "ghosts/" + ghost_name(figures.ghost);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool selected = ui.studio.selection.ghost == figures.ghost, is_there = figures.relative_flux > 0;
  ImGui::PushID(id.c_str());
  if (ImGui::Selectable(fmt::format("{}", rank).c_str(), selected,
                        ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
    ui.studio.select_ghost(selected ? std::nullopt : std::optional<Ghost>(figures.ghost));
  ImGui::PopID();
  if (selected && ui.state.ghost_in_sight != figures.ghost) {
    if (!is_wholly_in_sight()) ImGui::SetScrollHereY(0.5F);
    ui.state.ghost_in_sight = figures.ghost;
  }
  ui.registry.record(id, selected ? "selected" : "");
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(ghost_name(figures.ghost).c_str());
  ImGui::TableNextColumn();
  const double brightest = std::fmax(figures.rgb[0], std::fmax(figures.rgb[1], figures.rgb[2]));
  if (is_there && brightest > 0) colour_patch(display_colour(figures.rgb, brightest), scaled(14));
  if (is_there)
    draw_ghost_figures(ui, figures, largest);
  else
    draw_absence();
  ImGui::TableNextColumn();
  draw_switches(ui, figures.ghost, id);
  ImGui::TableNextColumn();
  draw_gain(ui, figures.ghost, id);
}

// Columns are as wide as their texts; where the panel is narrower, it scrolls.
// The row of a ghost that was selected elsewhere since the last frame; -1: none.
int row_to_bring_into_sight(Ui& ui, const std::vector<GhostRow>& rows) {
  const auto ghost = ui.studio.selection.ghost;
  if (!ghost) ui.state.ghost_in_sight.reset();
  if (!ghost || ui.state.ghost_in_sight == ghost) return -1;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (ui.studio.figures()[rows[k].figures].ghost == *ghost) return static_cast<int>(k);
  return -1;
}

constexpr int kPeakColumn = 4;  // left out first where there is no room for all

// room: in the panel, a scroll bar included, so that columns stay where they are when the list becomes short.
void set_up_ghost_columns(const Ui& ui, float room) {
  const float most = static_cast<float>(ui.studio.figures().size());
  const std::array<std::pair<const char*, float>, 8> columns = {
      {{"#", text_width(most > 99 ? "000" : "00")},
       {"Ghost", std::max(text_width("Ghost"), text_width("00-00"))},
       {"", scaled(14)},
       {"Flux %", text_width("<0.0001")},
       {"Peak EV", std::max(text_width("Peak EV"), text_width("-00.0"))},
       {"Size px", std::max(text_width(">10 frames"), text_width("000 sharp"))},
       {"", scaled(44)},
       {"Gain", scaled(42)}}};
  float all = ImGui::GetStyle().ScrollbarSize;
  for (const auto& column : columns) all += column.second + 2 * ImGui::GetStyle().CellPadding.x;
  const float left = std::floor(std::max(0.0F, room - all) / 4);
  ImGui::TableSetColumnEnabled(kPeakColumn, all <= room);
  ImGui::TableSetupScrollFreeze(2, 1);
  for (std::size_t k = 0; k < columns.size(); ++k)
    ImGui::TableSetupColumn(columns[k].first, ImGuiTableColumnFlags_WidthFixed,
                            columns[k].second + (k == 1 || (k >= 3 && k <= 5) ? left : 0));
  heading_row(
      {"Rank in the order chosen above",
       "The surfaces where the light reflects, counted from the front: 3-8 reflects at 8, then at 3",
       "The ghost's colour", "Part of the light that reaches the sensor directly, in per cent",
       "Its brightest pixel, in stops (EV) below that of the ghost with the brightest one of all",
       "The longer side in pixels, or in frames: widths of the frame. Sharp: in focus for a light on the axis, a small "
       "bright spot.",
       "S: solo, M: mute", "1 is physically right"});
}

void draw_ghost_table(Ui& ui, const std::vector<GhostRow>& rows, ImGuiTableFlags flags) {
  const float room = ImGui::GetContentRegionAvail().x;
  if (!ImGui::BeginTable("ghosts", 8, flags)) return;
  set_up_ghost_columns(ui, room);
  const double largest = largest_peak(ui);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()));
  if (const int selected = row_to_bring_into_sight(ui, rows); selected >= 0)
    clipper.ForceDisplayRangeByIndices(selected, selected + 1);
  while (clipper.Step())
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k)
      draw_ghost_row(ui, rows[static_cast<std::size_t>(k)], largest);
  ImGui::EndTable();
}

}  // namespace

void draw_ghosts_panel(Ui& ui) {
  draw_ghost_controls(ui);
  const auto rows = rows_of(ui);
  draw_summary(ui, rows.size());
  constexpr ImGuiTableFlags flags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                    ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingFixedFit |
                                    ImGuiTableFlags_Hideable;
  const ImGuiStyle& style = ImGui::GetStyle();
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(scaled(4), style.CellPadding.y));
  draw_ghost_table(ui, rows, flags);
  ImGui::PopStyleVar();
}

}  // namespace contrejour::studio
