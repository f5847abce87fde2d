// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/interface.h"

#include <algorithm>
#include <array>
#include <utility>

#include <imgui_internal.h>

#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/plate.h"
#include "studio/ui/keys.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr float kBarHeight = 44, kStatusHeight = 28, kSplit = 5;
constexpr float kLeastSide = 330, kLeastBottom = 150, kLeastViewport = 220;
constexpr float kMostOfWindow =
    0.42F;  // for panels at the side or the bottom: in a small window the picture comes first
// The frame is cleared to the panels' colour, so that they need not be filled: without a graphics card filling takes
// most of a frame's time.
constexpr ImGuiWindowFlags kChildFlags = ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NoBackground;

template <class Tab, std::size_t Count>
void draw_tabs(WidgetRegistry& registry, const char* bar, const std::array<const char*, Count>& names, Tab& chosen,
               bool& was_chosen) {
  // In a narrow panel the tabs are narrower, so that none is cut off.
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = 0;
  for (const char* name : names)
    width += ImGui::CalcTextSize(name).x + 2 * style.FramePadding.x + style.ItemInnerSpacing.x;
  const bool is_narrow = width > ImGui::GetContentRegionAvail().x;
  if (is_narrow)
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.5F * style.FramePadding.x, style.FramePadding.y));
  const bool is_open = ImGui::BeginTabBar(bar);
  const auto end_style = [&] {
    if (is_narrow) ImGui::PopStyleVar();
  };
  if (!is_open) return end_style();
  for (std::size_t k = 0; k < Count; ++k) {
    const auto tab = static_cast<Tab>(k);
    const ImGuiTabItemFlags flags = was_chosen && tab == chosen ? ImGuiTabItemFlags_SetSelected : 0;
    const bool open = ImGui::BeginTabItem(names[k], nullptr, flags);
    registry.record(std::string("tab/") + names[k], open ? "open" : "");
    if (!open) continue;
    if (!was_chosen) chosen = tab;
    ImGui::EndTabItem();
  }
  was_chosen = false;
  ImGui::EndTabBar();
  end_style();
}

// A border that is dragged; `size` is that of the panel behind it, at scale 1.
void draw_splitter(const char* id, ImVec2 at, ImVec2 extent, bool is_upright, float& size, float least, float most) {
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton(id, extent);
  const bool used = ImGui::IsItemHovered() || ImGui::IsItemActive();
  const ImU32 colour = used ? colours::kAccentDim : ImGui::GetColorU32(ImGuiCol_WindowBg);
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + extent.x, at.y + extent.y}, colour);
  if (used) ImGui::SetMouseCursor(is_upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  if (!ImGui::IsItemActive()) return;
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  size = std::clamp(size - (is_upright ? moved.x : moved.y) / scaled(1), least, std::max(least, most));
}

}  // namespace

Interface::Interface(Studio& studio, double scale) : studio_(studio) {
  state_.started_scale = scale;
  state_.lost = studio.lost_work();
  if (state_.lost.empty()) return;
  state_.dialog = Dialog::Recover;
  state_.dialog_opens = true;
}

void Interface::take_picture() {
  if (studio_.shown_count() == shown_count_) return;
  shown_count_ = studio_.shown_count();
  const DisplayAnswer& shown = studio_.shown();
  if (!shown.rgba.empty()) picture_.set(shown.width, shown.height, shown.rgba);
}

void Interface::draw_side(float width, float height) {
  Ui ui{studio_, state_, registry_};
  ImGui::BeginChild("##side", {width, height}, false, kChildFlags);
  static constexpr std::array names = {"Ghosts", "Lights", "Looks", "Parameters", "History"};
  draw_tabs(registry_, "##side-tabs", names, state_.side, state_.side_was_chosen);
  switch (state_.side) {
    case SideTab::Ghosts: draw_ghosts_panel(ui); break;
    case SideTab::Lights: draw_lights_panel(ui); break;
    case SideTab::Looks: draw_looks_panel(ui, textures_); break;
    case SideTab::Parameters: draw_parameters_panel(ui); break;
    case SideTab::History: draw_history_panel(ui); break;
  }
  ImGui::EndChild();
}

void Interface::draw_bottom(float width, float height) {
  Ui ui{studio_, state_, registry_};
  ImGui::BeginChild("##bottom", {width, height}, false, kChildFlags);
  static constexpr std::array names = {"Section",  "Prescription", "Coatings", "Iris",
                                       "Timeline", "Compare",      "Measured"};
  draw_tabs(registry_, "##bottom-tabs", names, state_.bottom, state_.bottom_was_chosen);
  if (state_.bottom != BottomTab::Iris) studio_.want_point_spread(false);
  switch (state_.bottom) {
    case BottomTab::Section: draw_section_panel(ui); break;
    case BottomTab::Prescription: draw_prescription_panel(ui); break;
    case BottomTab::Coatings: draw_coatings_panel(ui); break;
    case BottomTab::Iris: draw_iris_panel(ui, textures_); break;
    case BottomTab::Timeline: draw_timeline_panel(ui); break;
    case BottomTab::Compare: draw_compare_panel(ui, textures_); break;
    case BottomTab::Measured: draw_measured_panel(ui, textures_); break;
  }
  ImGui::EndChild();
}

void Interface::draw_panels() {
  Ui ui{studio_, state_, registry_};
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float bar = scaled(kBarHeight), status = scaled(kStatusHeight), split = scaled(kSplit);
  const bool panels = state_.shows_panels;
  const float side = panels ? std::min(scaled(state_.side_width), kMostOfWindow * size.x) : 0;
  const float bottom = panels ? std::min(scaled(state_.bottom_height), kMostOfWindow * size.y) : 0;
  const float width = size.x - side - (panels ? split : 0),
              height = size.y - bar - status - bottom - (panels ? split : 0);
  ImGui::SetCursorPos({0, 0});
  ImGui::BeginChild("##toolbar", {size.x, bar}, false, kChildFlags | ImGuiWindowFlags_NoScrollbar);
  draw_toolbar(ui);
  ImGui::EndChild();
  ImGui::SetCursorPos({0, bar});
  ImGui::BeginChild(
      "##viewport", {width, height}, false,
      kChildFlags | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNavInputs);
  if (frames_ == 2 && state_.dialog == Dialog::None) ImGui::SetWindowFocus();
  // Escape hands the keyboard from a panel to the window around it, which would frame the viewport in blue.
  if (GImGui->NavWindow == ImGui::GetCurrentWindow()->ParentWindow) {
    ImGui::SetWindowFocus();
    GImGui->NavDisableHighlight = true;
  }
  state_.viewport_has_keys = ImGui::IsWindowFocused() || GImGui->NavWindow == nullptr;
  draw_viewport(ui, picture_);
  ImGui::EndChild();
  if (panels) {
    ImGui::SetCursorPos({0, bar + height + split});
    draw_bottom(width, bottom);
    ImGui::SetCursorPos({width + split, bar});
    draw_side(side, size.y - bar - status);
    const float least_view = kLeastViewport;
    draw_splitter("##split-side", {width, bar}, {split, size.y - bar - status}, true, state_.side_width, kLeastSide,
                  size.x / scaled(1) - least_view);
    draw_splitter("##split-bottom", {0, bar + height}, {width, split}, false, state_.bottom_height, kLeastBottom,
                  (size.y - bar - status) / scaled(1) - least_view);
  }
  ImGui::SetCursorPos({0, size.y - status});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(scaled(10), scaled(1)));
  ImGui::BeginChild("##status", {size.x, status}, false, kChildFlags | ImGuiWindowFlags_NoScrollbar);
  draw_status_bar(ui);
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

void Interface::draw_frame() {
  ++frames_;
  registry_.begin_frame();
  studio_.update();
  take_picture();
  Ui ui{studio_, state_, registry_};
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::Begin("##studio", nullptr, flags);
  ImGui::PopStyleVar();
  use_keys(ui);
  if (std::exchange(state_.asks_to_quit, false)) ask_to_quit();
  draw_panels();
  ImGui::End();
  draw_dialogs(ui);
  draw_help_overlay(ui);
}

bool Interface::needs_frame() const {
  return frames_ < 4 || state_.dialog_opens || ImGui::GetIO().WantTextInput || studio_.is_playing();
}

void Interface::open_file(const std::string& file) {
  if (is_measured_flare(file)) {
    studio_.open_measured(file);
    state_.bottom = BottomTab::Measured;
    state_.bottom_was_chosen = true;
    return;
  }
  if (is_session(file))
    studio_.open_session(file);
  else if (is_plate_name(file))
    studio_.open_plate(file);
  else
    studio_.open_lens(file);
}

void Interface::ask_to_quit() {
  if (studio_.is_saved()) {
    studio_.forget_autosave();
    state_.wants_to_quit = true;
    return;
  }
  state_.dialog = Dialog::Quit;
  state_.dialog_opens = true;
}

}  // namespace contrejour::studio
