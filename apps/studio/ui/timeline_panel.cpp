// SPDX-License-Identifier: Apache-2.0
// The timeline: frames, play, a row of keys for each value that has some. Values get their first key at the diamond
// beside them, in every panel.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "studio/core/plate_frames.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr float kRulerHeight = 26, kRowHeight = 24, kNameWidth = 190, kBetweenWidth = 84;

struct TimelineMap {
  float left = 0, right = 1;
  int first = 1, last = 2;
  [[nodiscard]] float x_of(double frame) const {
    const double span = std::max(1, last - first);
    return left + (right - left) * static_cast<float>((frame - first) / span);
  }
  [[nodiscard]] int frame_at(float x) const {
    const double part = static_cast<double>((x - left) / std::max(1.0F, right - left));
    return std::clamp(first + static_cast<int>(std::lround(part * (last - first))), first, last);
  }
};

void draw_frame_number(Ui& ui, const char* id, int& frame, const char* format, const char* help) {
  ImGui::SetNextItemWidth(scaled(76));
  ImGui::DragInt(fmt::format("##{}", id).c_str(), &frame, 0.2F, 0, 100000, format, ImGuiSliderFlags_AlwaysClamp);
  ui.registry.record(fmt::format("timeline/{}", id), fmt::format("{}", frame));
  tip(help);
}

void draw_range(Ui& ui) {
  View& view = ui.studio.view;
  draw_frame_number(ui, "first", view.first_frame, "from %d", "The first frame of the shot");
  ImGui::SameLine(0, scaled(4));
  draw_frame_number(ui, "last", view.last_frame, "to %d", "The last frame of the shot");
  view.last_frame = std::max(view.last_frame, view.first_frame);
  if (view.frame < view.first_frame || view.frame > view.last_frame) ui.studio.go_to_frame(view.frame);
  ImGui::SameLine(0, scaled(4));
  auto rate = static_cast<float>(view.frames_per_second);
  ImGui::SetNextItemWidth(scaled(64));
  if (ImGui::DragFloat("##rate", &rate, 0.1F, 1, 240, "%.4g fps", ImGuiSliderFlags_AlwaysClamp))
    view.frames_per_second = static_cast<double>(rate);
  ui.registry.record("timeline/rate", fmt::format("{}", rate));
  tip("Frames a second, for playing");
}

// A click on a light's diamond in the toolbar of the timeline keys its position.
void draw_light_key(Ui& ui) {
  const TrackId track{"", ui.studio.selection.light, LightPart::Position};
  const std::string label = fmt::format("Key light {}", ui.studio.selection.light + 1);
  if (button(ui, "timeline/key-light", label.c_str(),
             "A key of the selected light's position at this frame (K). Other values have a diamond in their panels."))
    ui.studio.edit(fmt::format("key of light {}", ui.studio.selection.light + 1), "",
                   [&](const Document& d) { return with_key(d, track, ui.studio.view.frame); });
}

void draw_controls(Ui& ui) {
  Studio& studio = ui.studio;
  const bool plays = studio.is_playing();
  if (button(ui, "timeline/play", plays ? "Stop" : "Play", "Play the frames that are rendered (Space)",
             {scaled(58), 0}))
    studio.play(!plays);
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::Text("Frame %d", studio.view.frame);
  ui.registry.record("timeline/frame", fmt::format("{}", studio.view.frame));
  ImGui::SameLine(0, scaled(14));
  draw_range(ui);
  ImGui::SameLine(0, scaled(14));
  draw_light_key(ui);
}

// The frames of a sequence, with gaps in red where one is missing.
void draw_plate_frames(const Ui& ui, const TimelineMap& map, ImVec2 at) {
  const auto frames = ui.studio.plate_frames();
  if (frames.empty()) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto bar = [&](double from, double to, ImU32 colour) {
    list.AddRectFilled({std::max(map.left, map.x_of(from)), at.y},
                       {std::min(map.right, map.x_of(to)), at.y + scaled(3)}, colour);
  };
  bar(std::max(map.first, frames.front()) - 0.5, std::min(map.last, frames.back()) + 0.5, colours::kAccentDim);
  for (const int frame : missing_frames(frames, map.first, map.last)) bar(frame - 0.5, frame + 0.5, colours::kBad);
}

void draw_ruler(Ui& ui, const TimelineMap& map, ImVec2 min, float bottom) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float height = scaled(kRulerHeight);
  ImGui::SetCursorScreenPos({map.left, min.y});
  ImGui::InvisibleButton("##ruler", {std::max(1.0F, map.right - map.left), height});
  ui.registry.record("timeline/ruler", fmt::format("{}", ui.studio.view.frame));
  if (ImGui::IsItemActive()) {
    const int frame = map.frame_at(ImGui::GetIO().MousePos.x);
    if (frame != ui.studio.view.frame) ui.studio.go_to_frame(frame);
  }
  const int span = map.last - map.first;
  int step = 1;
  for (const int nice : {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000}) {
    step = nice;
    if (static_cast<float>(span) / static_cast<float>(nice) * scaled(44) < map.right - map.left) break;
  }
  for (int frame = map.first; frame <= map.last; ++frame)
    if (ui.studio.frame_cache().has(frame) && ui.studio.is_playing())
      list.AddRectFilled({map.x_of(frame - 0.5), min.y + height - scaled(4)}, {map.x_of(frame + 0.5), min.y + height},
                         colours::kGood);
  draw_plate_frames(ui, map, {map.left, min.y + scaled(13)});
  const auto mark = [&](int frame) {
    const float x = map.x_of(frame);
    list.AddLine({x, min.y + scaled(14)}, {x, bottom}, IM_COL32(255, 255, 255, 18));
    const std::string text = std::to_string(frame);
    const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
    list.AddText(small_font(), small_font()->FontSize, {x - 0.5F * size.x, min.y}, colours::dim(), text.c_str());
  };
  mark(map.first);
  for (int frame = map.first / step * step + step; frame <= map.last; frame += step)
    if (map.x_of(frame) - map.x_of(map.first) > scaled(30)) mark(frame);
}

void draw_key(Ui& ui, const TimelineMap& map, const Track& track, const Key& key, float middle) {
  const float r = scaled(5.5F);
  KeyDrag& drag = ui.state.key_drag;
  const bool dragged = drag.on && drag.track == track.id && drag.frame == key.frame;
  const ImVec2 at = {map.x_of(key.frame), middle};
  ImGui::SetCursorScreenPos({at.x - r, at.y - r});
  ImGui::PushID(key.frame);
  ImGui::InvisibleButton("##key", {2 * r, 2 * r});
  ImGui::PopID();
  ui.registry.record(fmt::format("timeline/{}/{}", track.label, key.frame));
  const std::string value = text_at(track.value, key.frame);
  tip(fmt::format("Frame {}: {}\nDrag to another frame; a right click removes it.", key.frame, value).c_str());
  if (ImGui::IsItemActivated()) drag = {true, track.id, key.frame};
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))
    ui.studio.edit(fmt::format("remove key of {}", track.label), "",
                   [&](const Document& d) { return without_key(d, track.id, key.frame); });
  const ImVec2 points[] = {{at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}};
  const bool now = key.frame == ui.studio.view.frame;
  ImGui::GetWindowDrawList()->AddConvexPolyFilled(points, 4,
                                                  dragged || ImGui::IsItemHovered() ? colours::text()
                                                  : now                             ? colours::kAccent
                                                                                    : IM_COL32(190, 140, 70, 255));
}

// The key follows the mouse from frame to frame; a drag is one step of the history.
void drag_key(Ui& ui, const TimelineMap& map) {
  KeyDrag& drag = ui.state.key_drag;
  if (!drag.on) return;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    drag.on = false;
    ui.studio.end_gesture();
    return;
  }
  const int to = map.frame_at(ImGui::GetIO().MousePos.x);
  if (to == drag.frame) return;
  if (ui.studio.edit("move key", "timeline/key",
                     [&](const Document& d) { return with_key_moved(d, drag.track, drag.frame, to); }))
    drag.frame = to;
}

void draw_between(Ui& ui, const Track& track) {
  static constexpr std::array kNames = {"step", "linear", "smooth"};
  const auto now = static_cast<std::size_t>(track.value.between);
  ImGui::SetNextItemWidth(scaled(kBetweenWidth));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(scaled(6), scaled(1)));
  if (ImGui::BeginCombo("##between", kNames[now])) {
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      if (ImGui::Selectable(kNames[k], k == now))
        ui.studio.edit(fmt::format("{} keys of {}", kNames[k], track.label), "", [&](const Document& d) {
          return with_interpolation(d, track.id, static_cast<Interpolation>(k));
        });
      ui.registry.record(fmt::format("timeline/{}/{}", track.label, kNames[k]));
    }
    ImGui::EndCombo();
  }
  ImGui::PopStyleVar();
  ui.registry.record(fmt::format("timeline/{}/between", track.label), kNames[now]);
}

void draw_row(Ui& ui, const TimelineMap& map, const Track& track, ImVec2 at) {
  ImGui::PushID(track.label.c_str());
  ImGui::SetCursorScreenPos({at.x, at.y + scaled(3)});
  fitting_text(track.label, scaled(kNameWidth - kBetweenWidth - 8), colours::text());
  ui.registry.record(fmt::format("timeline/{}", track.label), text_at(track.value, ui.studio.view.frame));
  ImGui::SetCursorScreenPos({at.x + scaled(kNameWidth - kBetweenWidth - 4), at.y + scaled(2)});
  draw_between(ui, track);
  const float middle = at.y + 0.5F * scaled(kRowHeight);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddLine({map.left, middle}, {map.right, middle}, IM_COL32(255, 255, 255, 22));
  const auto& keys = track.value.keys;
  list.AddLine({std::max(map.left, map.x_of(keys.front().frame)), middle},
               {std::min(map.right, map.x_of(keys.back().frame)), middle}, colours::kAccentDim, scaled(2));
  for (const Key& key : keys)
    if (key.frame >= map.first && key.frame <= map.last) draw_key(ui, map, track, key, middle);
  ImGui::PopID();
}

void draw_tracks(Ui& ui) {
  const ImVec2 min = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const View& view = ui.studio.view;
  const TimelineMap map{min.x + scaled(kNameWidth + 14), min.x + room.x - scaled(18), view.first_frame,
                        view.last_frame};
  const auto tracks = tracks_of(ui.studio.document());
  const float rows = min.y + scaled(kRulerHeight + 4);
  const float bottom = rows + scaled(kRowHeight) * static_cast<float>(tracks.size());
  draw_ruler(ui, map, min, bottom);
  if (tracks.empty()) {
    ImGui::SetCursorScreenPos({min.x, rows + scaled(4)});
    ImGui::TextDisabled("No keys yet. K keys the selected light; a diamond beside a value keys that value.");
  }
  for (std::size_t k = 0; k < tracks.size(); ++k)
    draw_row(ui, map, tracks[k], {min.x, rows + scaled(kRowHeight) * static_cast<float>(k)});
  drag_key(ui, map);
  const float x = map.x_of(view.frame);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddLine({x, min.y + scaled(14)}, {x, bottom}, colours::kSelected, scaled(1.5F));
  list.AddTriangleFilled({x - scaled(5), min.y + scaled(14)}, {x + scaled(5), min.y + scaled(14)},
                         {x, min.y + scaled(21)}, colours::kSelected);
  ImGui::SetCursorScreenPos({min.x, bottom + (tracks.empty() ? scaled(kRowHeight) : 0)});
  ImGui::Dummy({1, scaled(4)});
}

}  // namespace

void draw_timeline_panel(Ui& ui) {
  draw_controls(ui);
  ImGui::BeginChild("##tracks");
  draw_tracks(ui);
  ImGui::EndChild();
}

}  // namespace contrejour::studio
