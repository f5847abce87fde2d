// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "studio/core/ghost_edits.h"
#include "studio/ui/theme.h"
#include "studio/ui/viewport_parts.h"

namespace contrejour::studio {
namespace {

constexpr int kOutlinePoints = 72;

const GhostFigures* selected_figures(const Studio& studio) {
  for (const GhostFigures& f : studio.figures())
    if (studio.selection.ghost == f.ghost) return &f;
  return nullptr;
}

std::string name_for_people(const Ghost& ghost) {
  std::string name = ghost_name(ghost);
  for (std::size_t at = name.find('-'); at != std::string::npos; at = name.find('-', at + 3))
    name.replace(at, 1, "\u2013");
  return name;
}

// None where no ray of its grid got through, and for ghosts that are too dim to be traced.
const GhostFootprint* footprint_called(const Studio& studio, const Ghost& ghost) {
  for (const GhostFootprint& footprint : studio.footprints())
    if (footprint.ghost == ghost && !footprint.border_px.empty()) return &footprint;
  return nullptr;
}

void draw_border(ImDrawList& list, const ViewportMap& map, const GhostFootprint& footprint, ImU32 colour) {
  for (const auto& side : footprint.border_px)
    list.AddLine(map.screen_of_pixel(side[0]), map.screen_of_pixel(side[1]), colour, scaled(1.5F));
}

void draw_ellipse(ImDrawList& list, ImVec2 at, float rx, float ry, ImU32 colour) {
  std::array<ImVec2, kOutlinePoints> points;
  for (int k = 0; k < kOutlinePoints; ++k) {
    const float t = 6.2831853F * static_cast<float>(k) / kOutlinePoints;
    points[static_cast<std::size_t>(k)] = {at.x + rx * std::cos(t), at.y + ry * std::sin(t)};
  }
  for (std::size_t k = 0; k + 1 < points.size(); k += 2) list.AddLine(points[k], points[k + 1], colour, scaled(1.5F));
}

}  // namespace

void draw_frame_guides(const ViewportMap& map) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 middle = map.screen_of_uv({0.5, 0.5});
  const float arm = scaled(6);
  constexpr ImU32 colour = IM_COL32(255, 255, 255, 70);
  list.AddLine({middle.x - arm, middle.y}, {middle.x + arm, middle.y}, colour);
  list.AddLine({middle.x, middle.y - arm}, {middle.x, middle.y + arm}, colour);
}

namespace {

// Which side of the wipe's edge is the snapshot, below the picture where there is room.
void draw_wipe_labels(Ui& ui, const ViewportMap& map, float x, float bottom) {
  const Studio& studio = ui.studio;
  const std::size_t index = std::min(studio.compare_view().snapshot, studio.snapshots().size() - 1);
  const float line = ImGui::GetTextLineHeight(), gap = scaled(8);
  const float y = std::fmin(bottom + scaled(2), map.canvas_max.y - line - scaled(2));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto label = [&](const std::string& text, float left) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    list.AddRectFilled({left - scaled(4), y}, {left + width + scaled(4), y + line}, colours::kShade, scaled(3));
    list.AddText({left, y}, colours::kText, text.c_str());
  };
  const std::string& name = studio.snapshots()[index].name;
  label(name, x - gap - ImGui::CalcTextSize(name.c_str()).x);
  label("now", x + gap);
  ui.registry.record("viewport/wipe/labels", {x - gap, y}, {x + gap, y + line}, name);
}

}  // namespace

bool use_wipe_edge(Ui& ui, const ViewportMap& map, bool is_hovered) {
  CompareView compare = ui.studio.compare_view();
  if (compare.mode != CompareMode::Wipe || ui.studio.snapshots().empty()) return false;
  const float x = map.screen_of_uv({compare.edge, 0}).x, reach = scaled(6);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float top = std::fmax(map.canvas_min.y, map.screen_of_uv({0, 0}).y),
              bottom = std::fmin(map.canvas_max.y, map.screen_of_uv({0, 1}).y);
  const bool near = is_hovered && std::fabs(mouse.x - x) < reach && mouse.y > top && mouse.y < bottom;
  if (near && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) ui.state.drags_wipe = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) ui.state.drags_wipe = false;
  if (ui.state.drags_wipe) {
    compare.edge = std::fmin(1.0, std::fmax(0.0, map.uv_of_screen(mouse).x));
    ui.studio.set_compare(compare);
  }
  const bool used = near || ui.state.drags_wipe;
  if (used) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  ImGui::GetWindowDrawList()->AddLine({x, top}, {x, bottom}, used ? colours::kText : colours::kAccent, scaled(1.5F));
  draw_wipe_labels(ui, map, x, bottom);
  ui.registry.record("viewport/wipe", {x - reach, top}, {x + reach, bottom}, fmt::format("{:.4f}", compare.edge));
  return used;
}

void draw_selected_ghost(Ui& ui, const ViewportMap& map) {
  const GhostFigures* ghost = selected_figures(ui.studio);
  if (ghost == nullptr || !ui.studio.view.shows_ghosts || !(ghost->relative_flux > 0)) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool is_shown = is_drawn(ui.studio.document(), ghost->ghost);
  const ImU32 colour = is_shown ? colours::kSelected : colours::kSelectedDim;
  const ImVec2 at = map.screen_of_pixel(ghost->centroid_px);
  const float rx = std::fmax(scaled(6), 0.5F * map.scale * static_cast<float>(ghost->size_px.x));
  const float ry = std::fmax(scaled(6), 0.5F * map.scale * static_cast<float>(ghost->size_px.y));
  const GhostFootprint* footprint = footprint_called(ui.studio, ghost->ghost);
  if (footprint != nullptr)
    draw_border(list, map, *footprint, colour);
  else
    draw_ellipse(list, at, rx, ry, colour);
  const std::string name = fmt::format("{}  {:.3g} %{}", name_for_people(ghost->ghost), 100 * ghost->relative_flux,
                                       is_shown ? "" : ", hidden");
  const ImVec2 size = ImGui::CalcTextSize(name.c_str());
  const ImVec2 text = {std::fmin(at.x + scaled(8), map.canvas_max.x - size.x - scaled(8)),
                       at.y - ry - size.y - scaled(4)};
  const ImVec2 label = {std::fmax(text.x, map.canvas_min.x + scaled(6)),
                        std::fmax(text.y, map.canvas_min.y + scaled(4))};
  list.AddRectFilled({label.x - scaled(5), label.y - scaled(1)},
                     {label.x + size.x + scaled(5), label.y + size.y + scaled(2)}, colours::kShade, scaled(3));
  list.AddText(label, colours::kSelected, name.c_str());
}

void draw_picture_badge(Ui& ui, bool is_short) {
  const DisplayAnswer& shown = ui.studio.shown();
  const bool is_draft = shown.picture.kind == PictureKind::Draft;
  const bool is_current = shown.picture.revision == ui.studio.revision();
  const ImU32 colour = is_draft || !is_current ? colours::kAccent : colours::kGood;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float r = scaled(4), height = ImGui::GetFrameHeight();
  ImGui::GetWindowDrawList()->AddCircleFilled({at.x + scaled(8), at.y + 0.5F * height}, r, colour);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + scaled(20));
  ImGui::AlignTextToFramePadding();
  const std::string kind = is_draft ? "Draft" : is_current ? "Refined" : "Updating\u2026";
  const std::string text =
      shown.width == 0 ? "rendering\u2026"
      : is_short       ? kind
                 : fmt::format("{}  {} \u00d7 {}   {:.0f} ms", kind, shown.width, shown.height, shown.picture.time_ms);
  ImGui::TextUnformatted(text.c_str());
  ui.registry.record("viewport/badge", is_draft ? "draft" : is_current ? "refined" : "updating");
  tip("Amber: a draft, coarser so that it follows the light. Green: the picture of the command line, bit for bit.");
}

}  // namespace contrejour::studio
