// SPDX-License-Identifier: Apache-2.0
// The section of the lens: glass, stop, sensor, rays that form the image or those of the selected ghost. A click on a
// surface selects it; a drag moves or bends it.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

struct SectionMap {
  ImVec2 origin;  // of z = 0 on the axis
  float scale = 1;
  [[nodiscard]] ImVec2 screen(Vec2 zy) const {
    return {origin.x + scale * static_cast<float>(zy.x), origin.y - scale * static_cast<float>(zy.y)};
  }
};

SectionMap section_map_of(const LensSection& section, ImVec2 min, ImVec2 max) {
  const float pad = scaled(22);
  const double wide = section.right_mm - section.left_mm, high = 2 * section.half_height_mm;
  const float across = (max.x - min.x - 2 * pad) / static_cast<float>(std::fmax(wide, 1e-6));
  const float down = (max.y - min.y - 1.6F * pad) / static_cast<float>(std::fmax(high, 1e-6));
  SectionMap map;
  map.scale = std::max(0.01F, std::min(across, down));
  map.origin = {0.5F * (min.x + max.x) - map.scale * static_cast<float>(0.5 * (section.left_mm + section.right_mm)),
                0.5F * (min.y + max.y)};
  return map;
}

std::vector<ImVec2> screen_points(const SectionCurve& curve, const SectionMap& map) {
  std::vector<ImVec2> points;
  for (const Vec2 p : polyline(curve, 0.3 / static_cast<double>(map.scale))) points.push_back(map.screen(p));
  return points;
}

constexpr float kRow_px = 2;

// Fills a polygon of any shape row by row; its outline hides the steps at the border.
void fill(ImDrawList& list, const std::vector<ImVec2>& polygon, ImU32 colour) {
  float top = 1e9F, bottom = -1e9F;
  for (const ImVec2 p : polygon) {
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  std::vector<float> crossings;
  for (float y = std::ceil(top); y < bottom; y += kRow_px) {
    crossings.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const ImVec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
      list.AddRectFilled({crossings[k], y}, {crossings[k + 1], y + kRow_px}, colour);
  }
}

// Denser glass is bluer and brighter.
ImU32 glass_colour(double index) {
  const double t = std::clamp((index - 1.45) / 0.45, 0.0, 1.0);
  const auto mix = [t](double a, double b) { return static_cast<int>(std::lround(a + (b - a) * t)); };
  return IM_COL32(mix(66, 92), mix(96, 128), mix(118, 186), 255);
}

void draw_glass(ImDrawList& list, const LensSection& section, const SectionMap& map) {
  for (const SectionElement& element : section.elements) {
    const auto outline = screen_points(element.outline, map);
    fill(list, outline, glass_colour(element.index_d));
    list.AddPolyline(outline.data(), static_cast<int>(outline.size()), IM_COL32(170, 200, 230, 190), ImDrawFlags_Closed,
                     scaled(1));
  }
}

void draw_stop_and_sensor(ImDrawList& list, const LensSection& section, const SectionMap& map) {
  const SectionStop& stop = section.stop;
  for (const double side : {1.0, -1.0})
    list.AddLine(map.screen({stop.z_mm, side * stop.opening_mm}), map.screen({stop.z_mm, side * stop.outer_mm}),
                 colours::text(), scaled(3));
  const double half = section.sensor.half_height_mm;
  list.AddLine(map.screen({section.sensor.z_mm, -half}), map.screen({section.sensor.z_mm, half}), colours::dim(),
               scaled(3));
}

// Rays are cut off at the drawing's sides.
void draw_rays(ImDrawList& list, const LensSection& section, const SectionMap& map) {
  for (const SectionRay& ray : section.rays) {
    const bool ghost = ray.kind == SectionRayKind::Ghost;
    const ImU32 colour = ghost                              ? IM_COL32(240, 173, 78, ray.blocked ? 70 : 190)
                         : ray.kind == SectionRayKind::Axis ? IM_COL32(122, 199, 140, 150)
                                                            : IM_COL32(102, 178, 255, 150);
    std::vector<ImVec2> points;
    for (const Vec2 p : ray.points_mm) points.push_back(map.screen(p));
    list.AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, scaled(1));
    for (const Vec2 p : ray.reflections_mm) list.AddCircleFilled(map.screen(p), scaled(2.5F), colours::kAccent);
  }
}

float distance_to(const std::vector<ImVec2>& line, ImVec2 p) {
  float best = 1e9F;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const ImVec2 a = line[k], d = {line[k + 1].x - a.x, line[k + 1].y - a.y};
    const float along =
        std::clamp(((p.x - a.x) * d.x + (p.y - a.y) * d.y) / std::max(1e-6F, d.x * d.x + d.y * d.y), 0.0F, 1.0F);
    best = std::min(best, std::hypot(p.x - a.x - along * d.x, p.y - a.y - along * d.y));
  }
  return best;
}

void draw_number(ImDrawList& list, ImVec2 at, int surface, ImU32 colour) {
  const std::string text = std::to_string(surface);
  const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
  list.AddText(small_font(), small_font()->FontSize, {at.x - 0.5F * size.x, at.y - size.y - scaled(2)}, colour,
               text.c_str());
}

constexpr float kLeastDrag_px = 3;

void begin_surface_drag(Ui& ui, const SectionMap& map, int surface) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto& lens = ui.studio.document().lens;
  const auto row = static_cast<std::size_t>(surface) - 1;
  if (row >= lens->surfaces.size()) return;  // plates before the sensor are settings
  const double height = static_cast<double>((map.origin.y - mouse.y) / map.scale);
  ui.state.surface_drag = {true, false, surface, grip_at(lens->surfaces[row], height), mouse.x, map.scale, lens};
}

// The drawing may scale itself anew while the lens grows: the drag keeps the scale with which it began.
void drag_surface(Ui& ui) {
  SurfaceDrag& drag = ui.state.surface_drag;
  if (!drag.on) return;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (drag.has_moved) ui.studio.end_gesture();
    drag = {};
    return;
  }
  const float by = ImGui::GetIO().MousePos.x - drag.from_x;
  if (!drag.has_moved && std::fabs(by) < scaled(kLeastDrag_px)) return;
  if (ImGui::GetIO().MouseDelta.x == 0) return;
  drag.has_moved = true;
  const char* what = drag.grip == SurfaceGrip::Vertex ? "move" : "bend";
  ui.studio.edit(fmt::format("{} surface {}", what, drag.surface), fmt::format("section/{}", drag.surface),
                 [&](const Document& d) -> Result<Document> {
                   auto lens = with_surface_dragged(*drag.lens, static_cast<std::size_t>(drag.surface) - 1, drag.grip,
                                                    static_cast<double>(by / drag.scale));
                   if (!lens) return tl::unexpected(lens.error());
                   return with_edited_lens(d, std::move(*lens));
                 });
}

void draw_surfaces(Ui& ui, const LensSection& section, const SectionMap& map, bool hovered) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::optional<int> nearest;
  float best = scaled(7);
  const auto& ghost = ui.studio.selection.ghost;
  for (const SectionSurface& s : section.surfaces) {
    const int number = static_cast<int>(s.surface) + 1;
    const auto line = screen_points(s.curve, map);
    if (line.empty()) continue;
    const bool selected = ui.studio.selection.surface == number, reflects = ghost && ghost->reflects_at(number);
    if (selected || reflects)
      list.AddPolyline(line.data(), static_cast<int>(line.size()), reflects ? colours::kAccent : colours::kSelected, 0,
                       scaled(2.5F));
    // The surface of the second reflection below, so that numbers of neighbours are apart.
    const bool below = reflects && number == ghost->i;
    const ImVec2 end = below ? ImVec2{line.back().x, line.back().y + scaled(20)} : line.front();
    if (selected || reflects) draw_number(list, end, number, reflects ? colours::kAccent : colours::kSelected);
    const float away = distance_to(line, ImGui::GetIO().MousePos);
    if (hovered && away < best) {
      best = away;
      nearest = number;
    }
    const ImVec2 middle = line[line.size() / 2];
    ui.registry.record(fmt::format("section/surface/{}", number), {middle.x - 3, middle.y - 3},
                       {middle.x + 3, middle.y + 3}, selected ? "selected" : "");
    const ImVec2 rim = line.front();
    ui.registry.record(fmt::format("section/surface/{}/rim", number), {rim.x - 2, rim.y}, {rim.x + 2, rim.y + 4});
  }
  if (nearest && !ui.state.surface_drag.on)
    ImGui::SetTooltip("Surface %d\nDrag its middle along the axis, its rim to bend it", *nearest);
  if (!hovered || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return;
  ui.studio.selection.surface = nearest.value_or(0);
  if (nearest) begin_surface_drag(ui, map, *nearest);
}

void draw_legend(Ui& ui) {
  const auto& ghost = ui.studio.selection.ghost;
  const std::string text =
      ghost ? fmt::format("Ghost {}: the light reflects at surface {}, then at {}", ghost_name(*ghost), ghost->j,
                          ghost->i)
            : "Rays that form the image. Click a ghost in the picture or in its list to see its path.";
  fitting_text(text, ImGui::GetContentRegionAvail().x, ghost ? colours::kAccent : colours::dim());
  ui.registry.record("section/legend", text);
}

}  // namespace

void draw_section_panel(Ui& ui) {
  const ImVec2 min = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const ImVec2 max = {min.x + room.x, min.y + room.y};
  const ImVec2 local = ImGui::GetCursorPos();
  ImGui::InvisibleButton("##section", {std::max(1.0F, room.x), std::max(1.0F, room.y)});
  const bool hovered = ImGui::IsItemHovered();
  ui.registry.record("section");
  // Rays end below the legend.
  const ImVec2 upper = {min.x, min.y + ImGui::GetTextLineHeight() + scaled(6)};
  ImGui::PushClipRect(upper, max, true);
  if (const auto section = ui.studio.section().section) {
    const SectionMap map = section_map_of(*section, upper, max);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 axis = map.screen({0, 0});
    list.AddLine({min.x, axis.y}, {max.x, axis.y}, IM_COL32(255, 255, 255, 30));
    draw_glass(list, *section, map);
    draw_rays(list, *section, map);
    draw_stop_and_sensor(list, *section, map);
    draw_surfaces(ui, *section, map, hovered);
    drag_surface(ui);
  }
  ImGui::PopClipRect();
  ImGui::SetCursorPos({local.x + scaled(4), local.y + scaled(2)});
  draw_legend(ui);
}

}  // namespace contrejour::studio
