// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "studio/core/lights.h"
#include "studio/ui/theme.h"
#include "studio/ui/viewport_parts.h"

namespace contrejour::studio {
namespace {

constexpr float kHandleRadius = 9, kReach = 14;

// The place of a light's handle: inside the viewport, also for a light outside it.
ImVec2 handle_of(const ViewportMap& map, Vec2 uv) {
  const ImVec2 at = map.screen_of_uv(uv);
  const float inset = scaled(kHandleRadius + 5);
  return {std::clamp(at.x, map.canvas_min.x + inset, std::max(map.canvas_min.x + inset, map.canvas_max.x - inset)),
          std::clamp(at.y, map.canvas_min.y + inset, std::max(map.canvas_min.y + inset, map.canvas_max.y - inset))};
}

float distance(ImVec2 a, ImVec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

std::optional<std::size_t> handle_under_mouse(const std::vector<LightEntry>& lights, const ViewportMap& map) {
  std::optional<std::size_t> nearest;
  float best = scaled(kReach);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const float away = distance(handle_of(map, lights[k].at), ImGui::GetIO().MousePos);
    if (away <= best) {
      best = away;
      nearest = k;
    }
  }
  return nearest;
}

void draw_arrow(ImDrawList& list, ImVec2 at, ImVec2 target, ImU32 colour) {
  const float length = distance(at, target);
  if (length < 1) return;
  const ImVec2 to = {(target.x - at.x) / length, (target.y - at.y) / length};
  const float from = scaled(kHandleRadius - 2), size = scaled(6);
  const ImVec2 tip = {at.x + to.x * (from + size), at.y + to.y * (from + size)};
  const ImVec2 foot = {at.x + to.x * from, at.y + to.y * from};
  list.AddTriangleFilled(tip, {foot.x - to.y * size * 0.6F, foot.y + to.x * size * 0.6F},
                         {foot.x + to.y * size * 0.6F, foot.y - to.x * size * 0.6F}, colour);
}

// How far the light is outside the frame, in widths of the frame, beside its handle and within the canvas.
void draw_distance(Ui& ui, const ViewportMap& map, std::size_t index, ImVec2 handle, Vec2 uv, ImU32 colour) {
  const double across = std::fmax(std::fmax(-uv.x, uv.x - 1), 0.0);
  const double down = std::fmax(std::fmax(-uv.y, uv.y - 1), 0.0) * map.height / map.width;
  const double outside = std::hypot(across, down);
  if (!(outside > 0)) return;
  const std::string text = fmt::format("{:.2g} frame widths outside", outside);
  const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
  const float gap = scaled(kHandleRadius + 8);
  const bool is_right = handle.x + gap + size.x > map.canvas_max.x;
  const ImVec2 at = {is_right ? handle.x - gap - size.x : handle.x + gap,
                     std::clamp(handle.y - 0.5F * size.y, map.canvas_min.y, map.canvas_max.y - size.y)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x - scaled(3), at.y}, {at.x + size.x + scaled(3), at.y + size.y}, colours::kShade, scaled(3));
  list.AddText(small_font(), small_font()->FontSize, at, colour, text.c_str());
  ui.registry.record(fmt::format("viewport/light/{}/outside", index + 1), at, {at.x + size.x, at.y + size.y}, text);
}

void draw_handle(Ui& ui, const ViewportMap& map, std::size_t index, Vec2 uv) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool selected = ui.studio.selection.light == index;
  const ImVec2 at = handle_of(map, uv), true_place = map.screen_of_uv(uv);
  const ImU32 colour = selected ? colours::kAccent : IM_COL32(230, 232, 236, 200);
  const float r = scaled(kHandleRadius), gap = scaled(4);
  list.AddCircle(at, r + 1, IM_COL32(0, 0, 0, 160), 32, scaled(4));
  list.AddCircle(at, r, colour, 32, scaled(selected ? 2 : 1.5F));
  list.AddLine({at.x - r - gap, at.y}, {at.x - gap, at.y}, colour, 1);
  list.AddLine({at.x + gap, at.y}, {at.x + r + gap, at.y}, colour, 1);
  list.AddLine({at.x, at.y - r - gap}, {at.x, at.y - gap}, colour, 1);
  list.AddLine({at.x, at.y + gap}, {at.x, at.y + r + gap}, colour, 1);
  draw_arrow(list, at, true_place, colour);
  draw_distance(ui, map, index, at, uv, colour);
  if (lights_of(ui.studio.document()).size() > 1) {
    const std::string number = fmt::format("{}", index + 1);
    list.AddText(small_font(), small_font()->FontSize, {at.x + r + gap, at.y + scaled(4)}, colour, number.c_str());
  }
  ui.registry.record(fmt::format("viewport/light/{}", index + 1), {at.x - r, at.y - r}, {at.x + r, at.y + r},
                     fmt::format("{:.5f},{:.5f}", uv.x, uv.y));
}

void drag_light(Ui& ui, const ViewportMap& map, std::size_t light, ImVec2 grip) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseDelta.x == 0 && io.MouseDelta.y == 0) return;
  const Vec2 uv = map.uv_of_screen({io.MousePos.x + grip.x, io.MousePos.y + grip.y});
  ui.studio.edit(fmt::format("move light {}", light + 1), fmt::format("light/{}/at", light),
                 [&](const Document& d) { return with_light_at(d, light, uv); });
}

}  // namespace

void draw_light_handles(Ui& ui, const ViewportMap& map) {
  const auto lights = lights_of(ui.studio.document());
  for (std::size_t k = 0; k < lights.size(); ++k) draw_handle(ui, map, k, lights[k].at);
}

bool use_light_handles(Ui& ui, const ViewportMap& map, bool is_hovered) {
  LightDrag& drag = ui.state.drag;
  const auto lights = lights_of(ui.studio.document());
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (drag.on) ui.studio.end_gesture();
    drag.on = false;
  }
  if (drag.on && drag.light < lights.size()) {
    drag_light(ui, map, drag.light, drag.grip);
    return true;
  }
  const auto under = is_hovered && ui.studio.view.shows_handles ? handle_under_mouse(lights, map) : std::nullopt;
  if (under && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    const ImVec2 mouse = ImGui::GetIO().MousePos, at = handle_of(map, lights[*under].at);
    drag = {true, *under, {at.x - mouse.x, at.y - mouse.y}};
    ui.studio.select_light(*under);
  }
  const bool adds = !under && is_hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
  if (adds) {
    ui.studio.add_light(map.uv_of_screen(ImGui::GetIO().MousePos));
    ui.studio.select_ghost(std::nullopt);  // which the first of the two clicks has selected
  }
  return under.has_value() || adds;
}

}  // namespace contrejour::studio
