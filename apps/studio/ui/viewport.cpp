// SPDX-License-Identifier: Apache-2.0
// The viewport: the flare, lights to drag, exposure and view transform, zoom and pan, a probe of pixels.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/core/ghosts_under.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"
#include "studio/ui/viewport_parts.h"

namespace contrejour::studio {
namespace {

constexpr float kMargin = 0.06F;  // around the picture, in parts of it: lights outside are within reach
constexpr double kZoomStep = 1.15;

params::PixelSize size_of_picture(const Document& document) {
  const auto size = params::parse_size(document.text("size"));
  return size ? *size : params::PixelSize{1920, 1080};
}

ViewportMap map_of(const Ui& ui, ImVec2 min, ImVec2 max) {
  const auto size = size_of_picture(ui.studio.document());
  ViewportMap map{min, max, {}, 1, size.width, size.height};
  const float across = (max.x - min.x) / (1 + 2 * kMargin) / static_cast<float>(size.width);
  const float down = (max.y - min.y) / (1 + 2 * kMargin) / static_cast<float>(size.height);
  const float fit = std::max(1e-3F, std::min(across, down));
  const View& view = ui.studio.view;
  map.scale = fit * static_cast<float>(view.zoom);
  const float width = map.scale * static_cast<float>(size.width), height = map.scale * static_cast<float>(size.height);
  map.picture_min = {
      0.5F * (min.x + max.x) - 0.5F * width + static_cast<float>(view.pan.x) * fit * static_cast<float>(size.width),
      0.5F * (min.y + max.y) - 0.5F * height + static_cast<float>(view.pan.y) * fit * static_cast<float>(size.height)};
  return map;
}

// The point under the mouse stays there.
void zoom_about(Ui& ui, const ViewportMap& map, ImVec2 mouse, double factor) {
  View& view = ui.studio.view;
  const double zoom = std::clamp(view.zoom * factor, 0.2, 32.0);
  const double change = zoom / view.zoom;
  const float fit = map.scale / static_cast<float>(view.zoom);
  const ImVec2 middle = {0.5F * (map.canvas_min.x + map.canvas_max.x), 0.5F * (map.canvas_min.y + map.canvas_max.y)};
  const Vec2 unit{static_cast<double>(fit) * map.width, static_cast<double>(fit) * map.height};
  const Vec2 at{static_cast<double>(mouse.x - middle.x) / unit.x, static_cast<double>(mouse.y - middle.y) / unit.y};
  view.pan = at + (view.pan - at) * change;
  view.zoom = zoom;
}

void use_wheel_and_pan(Ui& ui, const ViewportMap& map, bool is_hovered) {
  const ImGuiIO& io = ImGui::GetIO();
  if (is_hovered && io.MouseWheel != 0)
    zoom_about(ui, map, io.MousePos, std::pow(kZoomStep, static_cast<double>(io.MouseWheel)));
  const bool pans = ImGui::IsItemActive() && (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) ||
                                              ImGui::IsMouseDragging(ImGuiMouseButton_Right, 3));
  if (!pans) return;
  const double fit = static_cast<double>(map.scale) / ui.studio.view.zoom;
  ui.studio.view.pan = ui.studio.view.pan + Vec2{static_cast<double>(io.MouseDelta.x) / (fit * map.width),
                                                 static_cast<double>(io.MouseDelta.y) / (fit * map.height)};
}

// A click selects the brightest ghost there; further clicks at the same place the next ones.
void select_under_mouse(Ui& ui, const ViewportMap& map) {
  const auto under =
      ghosts_under(ui.studio.figures(), map.pixel_of_screen(ImGui::GetIO().MousePos), ui.studio.footprints());
  if (under.empty()) {
    ui.studio.select_ghost(std::nullopt);
    return;
  }
  std::size_t chosen = 0;
  for (std::size_t k = 0; k < under.size(); ++k)
    if (ui.studio.selection.ghost == ui.studio.figures()[under[k]].ghost) chosen = (k + 1) % under.size();
  ui.studio.select_ghost(ui.studio.figures()[under[chosen]].ghost);
}

void draw_picture(Ui& ui, const ViewportMap& map, Texture& picture) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end = map.screen_of_pixel({static_cast<double>(map.width), static_cast<double>(map.height)});
  list.AddCallback(Texture::clear_canvas, nullptr);
  if (picture.is_empty()) {
    list.AddRectFilled(map.picture_min, end, IM_COL32(0, 0, 0, 255));
  } else {
    picture.set_smooth(map.scale < 2 || ui.studio.shown().picture.kind == PictureKind::Draft);
    list.AddImage(picture.id(), map.picture_min, end);
  }
  list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
  list.AddRect({map.picture_min.x - 1, map.picture_min.y - 1}, {end.x + 1, end.y + 1}, colours::kLine);
}

// In a narrow viewport the controls are narrower, and the badge says less.
bool is_narrow() { return ImGui::GetContentRegionMax().x < scaled(700); }

float exposure_width() { return scaled(is_narrow() ? 110 : 150); }
float transform_width() { return scaled(is_narrow() ? 84 : 120); }

void draw_exposure(Ui& ui) {
  Studio& studio = ui.studio;
  const auto given = params::parse_real(studio.document().text("exposure"));
  auto stops = static_cast<float>(given ? *given : studio.shown().stops);
  ImGui::SetNextItemWidth(exposure_width());
  if (ImGui::DragFloat("##exposure", &stops, 0.02F, -40, 40,
                       given && !is_narrow() ? "Exposure %+.1f EV"
                       : given               ? "%+.1f EV"
                       : is_narrow()         ? "Auto %+.1f"
                                             : "Auto %+.1f EV")) {
    studio.edit("set exposure", "exposure",
                [&](const Document& d) { return with_value(d, "exposure", fmt::format("{:.2f}", stops)); });
    studio.refresh_display();
  }
  if (ImGui::IsItemDeactivated()) studio.end_gesture();
  ui.registry.record("viewport/exposure", fmt::format("{:.3f}", stops));
  tip("The exposure of the view, and of PNG previews. Drag, or click to type.");
  ImGui::SameLine();
  if (!given) ImGui::PushStyleColor(ImGuiCol_Text, colours::kAccent);
  const bool becomes_automatic = button(ui, "viewport/auto-exposure", "Auto",
                                        given ? "Derive the exposure from the picture's brightest parts"
                                              : "The exposure follows the picture's brightest parts until you set it");
  if (!given) ImGui::PopStyleColor();
  if (becomes_automatic && given) {
    studio.edit("automatic exposure", "",
                [](const Document& d) { return Result<Document>(without_value(d, "exposure")); });
    studio.refresh_display();
  }
}

void draw_header(Ui& ui, const ViewportMap& map) {
  draw_picture_badge(ui, is_narrow());
  align_right({"Auto"}, exposure_width() + transform_width() + scaled(66) + 3 * ImGui::GetStyle().ItemSpacing.x);
  draw_exposure(ui);
  ImGui::SameLine();
  draw_view_choice(ui, transform_width());
  ImGui::SameLine();
  const std::string zoom = fmt::format("{:.0f} %###zoom", 100.0 * static_cast<double>(map.scale));
  if (button(ui, "viewport/fit", zoom.c_str(), "Fit the picture (Z). The wheel zooms, the right button pans.",
             {scaled(66), 0})) {
    ui.studio.view.zoom = 1;
    ui.studio.view.pan = {};
  }
}

void probe_pixel(Ui& ui, const ViewportMap& map, bool is_hovered) {
  ui.state.probe = {-1, -1};
  if (!is_hovered || !map.is_in_picture(ImGui::GetIO().MousePos)) return;
  const Vec2 p = map.pixel_of_screen(ImGui::GetIO().MousePos);
  ui.state.probe = {static_cast<float>(p.x), static_cast<float>(p.y)};
}

}  // namespace

void draw_viewport(Ui& ui, Texture& picture) {
  const float header = ImGui::GetFrameHeightWithSpacing();
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 min = {start.x, start.y + header}, max = {start.x + room.x, start.y + room.y};
  const ViewportMap map = map_of(ui, min, max);
  draw_header(ui, map);
  ImGui::SetCursorScreenPos(min);
  ImGui::InvisibleButton(
      "##canvas", {std::max(1.0F, max.x - min.x), std::max(1.0F, max.y - min.y)},
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle | ImGuiButtonFlags_MouseButtonRight);
  ImGui::SetItemAllowOverlap();
  ui.registry.record("viewport", fmt::format("{}x{}", map.width, map.height));
  const ImVec2 end = map.screen_of_pixel({static_cast<double>(map.width), static_cast<double>(map.height)});
  ui.registry.record("viewport/picture", map.picture_min, end);
  const bool hovered = ImGui::IsItemHovered();
  ImGui::PushClipRect(min, max, true);
  draw_picture(ui, map, picture);
  draw_frame_guides(map);
  use_wheel_and_pan(ui, map, hovered);
  const bool on_edge = use_wipe_edge(ui, map, hovered);
  const bool on_handle = on_edge || use_light_handles(ui, map, hovered);
  if (!on_handle && hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) select_under_mouse(ui, map);
  probe_pixel(ui, map, hovered);
  draw_selected_ghost(ui, map);
  if (ui.studio.view.shows_handles) draw_light_handles(ui, map);
  ImGui::PopClipRect();
}

}  // namespace contrejour::studio
