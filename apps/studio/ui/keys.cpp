// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/keys.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/core/ghost_edits.h"
#include "studio/core/lights.h"
#include "studio/ui/input.h"

namespace contrejour::studio {
namespace {

void nudge(Ui& ui, double x_px, double y_px) {
  const auto lights = lights_of(ui.studio.document());
  const std::size_t k = ui.studio.selection.light;
  const auto size = params::parse_size(ui.studio.document().text("size"));
  if (k >= lights.size() || !size) return;
  const Vec2 to = lights[k].at + Vec2{x_px / size->width, y_px / size->height};
  ui.studio.edit(fmt::format("move light {}", k + 1), fmt::format("light/{}/nudge", k),
                 [&](const Document& d) { return with_light_at(d, k, to); });
}

void step_ghost(Ui& ui, int by) {
  const auto& figures = ui.studio.figures();
  if (figures.empty()) return;
  int at = -1;
  for (std::size_t k = 0; k < figures.size(); ++k)
    if (ui.studio.selection.ghost == figures[k].ghost) at = static_cast<int>(k);
  const int count = static_cast<int>(figures.size());
  const int next = at < 0 ? (by > 0 ? 0 : count - 1) : (at + by + count) % count;
  ui.studio.select_ghost(figures[static_cast<std::size_t>(next)].ghost);
}

void toggle_ghost(Ui& ui, bool solo) {
  const auto ghost = ui.studio.selection.ghost;
  if (!ghost) return;
  const Document& now = ui.studio.document();
  const bool on = solo ? is_solo(now, *ghost) : is_muted(now, *ghost);
  const std::string name =
      fmt::format("{} ghost {}", solo ? (on ? "end solo of" : "solo") : (on ? "unmute" : "mute"), ghost_name(*ghost));
  ui.studio.edit(name, "",
                 [&](const Document& d) { return solo ? with_solo(d, *ghost, !on) : with_mute(d, *ghost, !on); });
}

void show_ghosts_of_surface(Ui& ui) {
  const int surface = ui.studio.selection.surface;
  if (surface > 0)
    ui.studio.edit(fmt::format("ghosts of surface {}", surface), "",
                   [&](const Document& d) { return with_ghosts_of_surface(d, surface); });
}

void change_exposure(Ui& ui, double by) {
  const auto given = params::parse_real(ui.studio.document().text("exposure"));
  const double stops = (given ? *given : ui.studio.shown().stops) + by;
  ui.studio.edit("set exposure", "exposure",
                 [&](const Document& d) { return with_value(d, "exposure", fmt::format("{:.2f}", stops)); });
  ui.studio.refresh_display();
}

void remove_light(Ui& ui) {
  const std::size_t k = ui.studio.selection.light;
  if (k < lights_of(ui.studio.document()).size())
    ui.studio.edit(fmt::format("remove light {}", k + 1), "", [&](const Document& d) { return without_light(d, k); });
}

constexpr std::array kScales = {0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0};

void change_scale(Ui& ui, int by) {
  const double now = scale_of(ui.studio.view, ui.state);
  if (by > 0) {
    const auto* larger = std::ranges::upper_bound(kScales, now + 0.01);
    if (larger != kScales.end()) ui.studio.view.interface_scale = *larger;
  } else {
    const auto* smaller = std::ranges::lower_bound(kScales, now - 0.01);
    if (smaller != kScales.begin()) ui.studio.view.interface_scale = *std::prev(smaller);
  }
}

void set_compare_mode(Ui& ui, CompareMode mode) {
  CompareView compare = ui.studio.compare_view();
  compare.mode = compare.mode == mode ? CompareMode::Off : mode;
  if (!ui.studio.snapshots().empty()) ui.studio.set_compare(compare);
}

void key_light(Ui& ui) {
  const TrackId track{"", ui.studio.selection.light, LightPart::Position};
  ui.studio.edit(fmt::format("key of light {}", track.light + 1), "",
                 [&](const Document& d) { return with_key(d, track, ui.studio.view.frame); });
}

void show_side(Ui& ui, SideTab tab) {
  ui.state.side = tab;
  ui.state.side_was_chosen = true;
  ui.state.shows_panels = true;
}

void show_bottom(Ui& ui, BottomTab tab) {
  ui.state.bottom = tab;
  ui.state.bottom_was_chosen = true;
  ui.state.shows_panels = true;
}

void save(Ui& ui) {
  if (ui.studio.file().empty())
    open_dialog(ui, Dialog::SaveAs);
  else
    ui.studio.save_session(ui.studio.file());
}

constexpr std::array kKeys = {
    KeyCommand{"ctrl+o", "Ctrl+O", "Files", "open a lens or a session",
               [](Ui& ui) { open_dialog(ui, Dialog::OpenLens); }},
    KeyCommand{"ctrl+s", "Ctrl+S", "Files", "save the session", save},
    KeyCommand{"ctrl+shift+s", "Ctrl+Shift+S", "Files", "save under another name",
               [](Ui& ui) { open_dialog(ui, Dialog::SaveAs, ui.studio.file()); }},
    KeyCommand{"ctrl+e", "Ctrl+E", "Files", "export the picture",
               [](Ui& ui) { open_dialog(ui, Dialog::Export, file_to_export(ui)); }},
    KeyCommand{"ctrl+q", "Ctrl+Q", "Files", "quit", [](Ui& ui) { ui.state.asks_to_quit = true; }},
    KeyCommand{"ctrl+z", "Ctrl+Z", "History", "undo", [](Ui& ui) { ui.studio.undo(); }},
    KeyCommand{"ctrl+shift+z", "Ctrl+Shift+Z", "History", "redo", [](Ui& ui) { ui.studio.redo(); }},
    KeyCommand{"ctrl+y", "Ctrl+Y", "History", "redo", [](Ui& ui) { ui.studio.redo(); }},
    KeyCommand{"left", "Arrows", "Lights", "move the light (Shift: by 10)", [](Ui& ui) { nudge(ui, -1, 0); }},
    KeyCommand{"right", "", "Lights", "", [](Ui& ui) { nudge(ui, 1, 0); }},
    KeyCommand{"up", "", "Lights", "", [](Ui& ui) { nudge(ui, 0, -1); }},
    KeyCommand{"down", "", "Lights", "", [](Ui& ui) { nudge(ui, 0, 1); }},
    KeyCommand{"shift+left", "", "Lights", "", [](Ui& ui) { nudge(ui, -10, 0); }},
    KeyCommand{"shift+right", "", "Lights", "", [](Ui& ui) { nudge(ui, 10, 0); }},
    KeyCommand{"shift+up", "", "Lights", "", [](Ui& ui) { nudge(ui, 0, -10); }},
    KeyCommand{"shift+down", "", "Lights", "", [](Ui& ui) { nudge(ui, 0, 10); }},
    KeyCommand{"l", "L", "Lights", "add a light (or double-click)",
               [](Ui& ui) { ui.studio.add_light(kPlaceOfNewLight); }},
    KeyCommand{"shift+l", "Shift+L", "Lights", "lights where the plate is bright",
               [](Ui& ui) { ui.studio.detect_lights(); }},
    KeyCommand{"delete", "Delete", "Lights", "remove the selected light", remove_light},
    KeyCommand{"]", "]", "Ghosts", "the next dimmer ghost", [](Ui& ui) { step_ghost(ui, 1); }},
    KeyCommand{"[", "[", "Ghosts", "the next brighter ghost", [](Ui& ui) { step_ghost(ui, -1); }},
    KeyCommand{"s", "S", "Ghosts", "the selected ghost alone", [](Ui& ui) { toggle_ghost(ui, true); }},
    KeyCommand{"m", "M", "Ghosts", "mute the selected ghost", [](Ui& ui) { toggle_ghost(ui, false); }},
    KeyCommand{"g", "G", "Ghosts", "only ghosts of the surface", show_ghosts_of_surface},
    KeyCommand{"a", "A", "Ghosts", "show all ghosts",
               [](Ui& ui) {
                 ui.studio.edit("show all ghosts", "",
                                [](const Document& d) { return Result<Document>(with_all_ghosts(d)); });
               }},
    KeyCommand{"=", "=", "View", "brighter by half a stop", [](Ui& ui) { change_exposure(ui, 0.5); }},
    KeyCommand{"-", "-", "View", "darker by half a stop", [](Ui& ui) { change_exposure(ui, -0.5); }},
    KeyCommand{"z", "Z", "View", "fit the picture",
               [](Ui& ui) {
                 ui.studio.view.zoom = 1;
                 ui.studio.view.pan = {};
               }},
    KeyCommand{"h", "H", "View", "handles of the lights on or off",
               [](Ui& ui) { ui.studio.view.shows_handles = !ui.studio.view.shows_handles; }},
    KeyCommand{"tab", "Tab", "View", "panels on or off",
               [](Ui& ui) { ui.state.shows_panels = !ui.state.shows_panels; }},
    KeyCommand{"c", "C", "Compare", "take a snapshot", [](Ui& ui) { ui.studio.take_snapshot(); }},
    KeyCommand{"w", "W", "Compare", "wipe to the snapshot", [](Ui& ui) { set_compare_mode(ui, CompareMode::Wipe); }},
    KeyCommand{"d", "D", "Compare", "difference from the snapshot",
               [](Ui& ui) { set_compare_mode(ui, CompareMode::Difference); }},
    KeyCommand{"space", "Space", "Frames", "play, or stop", [](Ui& ui) { ui.studio.play(!ui.studio.is_playing()); }},
    KeyCommand{",", ",", "Frames", "the frame before", [](Ui& ui) { ui.studio.go_to_frame(ui.studio.view.frame - 1); }},
    KeyCommand{".", ".", "Frames", "the next frame", [](Ui& ui) { ui.studio.go_to_frame(ui.studio.view.frame + 1); }},
    KeyCommand{"home", "Home", "Frames", "the first frame",
               [](Ui& ui) { ui.studio.go_to_frame(ui.studio.view.first_frame); }},
    KeyCommand{"end", "End", "Frames", "the last frame",
               [](Ui& ui) { ui.studio.go_to_frame(ui.studio.view.last_frame); }},
    KeyCommand{"k", "K", "Frames", "key the selected light here", key_light},
    KeyCommand{"ctrl+=", "Ctrl+=  Ctrl+-", "View", "larger, smaller interface", [](Ui& ui) { change_scale(ui, 1); }},
    KeyCommand{"ctrl+shift+=", "", "View", "", [](Ui& ui) { change_scale(ui, 1); }},
    KeyCommand{"ctrl+-", "", "View", "", [](Ui& ui) { change_scale(ui, -1); }},
    KeyCommand{"ctrl+0", "Ctrl+0", "View", "interface as it was at the start",
               [](Ui& ui) { ui.studio.view.interface_scale = 0; }},
    KeyCommand{"f1", "F1", "View", "these keys", [](Ui& ui) { ui.state.shows_help = !ui.state.shows_help; }},
    KeyCommand{"f2", "F2", "Panels", "section of the lens", [](Ui& ui) { show_bottom(ui, BottomTab::Section); }},
    KeyCommand{"f3", "F3", "Panels", "prescription", [](Ui& ui) { show_bottom(ui, BottomTab::Prescription); }},
    KeyCommand{"f4", "F4", "Panels", "coatings", [](Ui& ui) { show_bottom(ui, BottomTab::Coatings); }},
    KeyCommand{"f5", "F5", "Panels", "ghosts", [](Ui& ui) { show_side(ui, SideTab::Ghosts); }},
    KeyCommand{"f6", "F6", "Panels", "lights", [](Ui& ui) { show_side(ui, SideTab::Lights); }},
    KeyCommand{"f7", "F7", "Panels", "parameters", [](Ui& ui) { show_side(ui, SideTab::Parameters); }},
    KeyCommand{"f8", "F8", "Panels", "history", [](Ui& ui) { show_side(ui, SideTab::History); }},
    KeyCommand{"f9", "F9", "Panels", "looks", [](Ui& ui) { show_side(ui, SideTab::Looks); }},
    KeyCommand{"f10", "F10", "Panels", "iris, starburst, dirt", [](Ui& ui) { show_bottom(ui, BottomTab::Iris); }},
    KeyCommand{"f11", "F11", "Panels", "timeline", [](Ui& ui) { show_bottom(ui, BottomTab::Timeline); }},
    KeyCommand{"f12", "F12", "Panels", "compare", [](Ui& ui) { show_bottom(ui, BottomTab::Compare); }},
    KeyCommand{"shift+f12", "Shift+F12", "Panels", "measured flare",
               [](Ui& ui) { show_bottom(ui, BottomTab::Measured); }},
};

// These move between widgets where a panel has the keyboard.
bool belongs_to_viewport(const char* chord) {
  const std::string_view keys(chord);
  return keys == "tab" || keys == "space" || keys == "home" || keys == "end" || keys.ends_with("left") ||
         keys.ends_with("right") || keys.ends_with("up") || keys.ends_with("down");
}

bool is_modifier(int key) {
  return key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_LEFT_ALT;
}

// The chord's last key was pressed in this frame, and exactly its modifiers are held.
bool is_pressed(const char* chord) {
  const ImGuiIO& io = ImGui::GetIO();
  bool ctrl = false, shift = false, alt = false;
  int last = 0;
  for (const int key : keys_of_chord(chord)) {
    ctrl |= key == GLFW_KEY_LEFT_CONTROL;
    shift |= key == GLFW_KEY_LEFT_SHIFT;
    alt |= key == GLFW_KEY_LEFT_ALT;
    if (key != 0 && !is_modifier(key)) last = key;
  }
  return last != 0 && io.KeyCtrl == ctrl && io.KeyShift == shift && io.KeyAlt == alt && ImGui::IsKeyPressed(last, true);
}

}  // namespace

std::span<const KeyCommand> all_keys() { return kKeys; }

void use_keys(Ui& ui) {
  if (ui.state.shows_help && ImGui::IsKeyPressed(GLFW_KEY_ESCAPE)) ui.state.shows_help = false;
  if (ui.state.dialog != Dialog::None || ImGui::GetIO().WantTextInput) return;
  for (const KeyCommand& key : kKeys)
    if (is_pressed(key.chord) && (ui.state.viewport_has_keys || !belongs_to_viewport(key.chord))) key.act(ui);
}

}  // namespace contrejour::studio
