// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/parameter_widgets.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

using params::Kind;
using params::Parameter;

constexpr double kWidestSlider = 1000.0;  // a wider range is dragged, not slid

// The value that the lens or the picture gives where the user has not set one.
std::string default_text(const Ui& ui, const Parameter& p) {
  if (!p.fallback.empty()) return std::string(p.fallback);
  if (p.name == "focal") return fmt::format("{:.4g}", ui.studio.lens().focal_length_mm);
  if (p.name == "fnumber") return fmt::format("{:.3g}", ui.studio.lens().f_number);
  return p.kind == Kind::Switch ? "off" : "";
}

void set(Ui& ui, const Parameter& p, const std::string& text, const std::string& key) {
  ui.studio.edit(fmt::format("set {}", p.name), key, [&](const Document& d) { return with_value(d, p.name, text); });
}

void draw_number(Ui& ui, const Parameter& p, const std::string& shown, float width) {
  const auto value = params::parse_real(shown);
  auto number = static_cast<float>(value ? *value : 0.0);
  const bool whole = p.kind == Kind::Integer;
  const bool slides = p.maximum - p.minimum <= kWidestSlider && std::isfinite(p.maximum - p.minimum);
  const auto low = static_cast<float>(std::max(p.minimum, -1e9)), high = static_cast<float>(std::min(p.maximum, 1e9));
  const char* format = !value ? "auto" : whole ? "%.0f" : "%.4g";
  const std::string key = fmt::format("parameter/{}", p.name);
  NumberDrag& drag = ui.state.number_drag;
  if (drag.id == key) number = drag.value;
  ImGui::SetNextItemWidth(width);
  const float speed = whole ? 0.1F : std::max(1e-4F, 0.005F * std::fabs(number));
  const bool changed =
      slides && !whole && p.maximum - p.minimum <= 100
          ? drag_bar("##value", number, low, high, format)
          : ImGui::DragFloat("##value", &number, speed, low, high, format, ImGuiSliderFlags_AlwaysClamp);
  if (ImGui::IsItemActive())
    drag = {key, number};
  else if (drag.id == key)
    drag = {};
  if (changed) set(ui, p, whole ? fmt::format("{:.0f}", number) : fmt::format("{:.5g}", number), key);
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
}

void draw_choice(Ui& ui, const Parameter& p, const std::string& shown, float width) {
  ImGui::SetNextItemWidth(width);
  if (!ImGui::BeginCombo("##value", shown.empty() ? "auto" : shown.c_str())) return;
  for (const std::string_view choice : p.choices) {
    if (ImGui::Selectable(std::string(choice).c_str(), choice == shown)) set(ui, p, std::string(choice), "");
    ui.registry.record(fmt::format("parameters/{}/{}", p.name, choice));
  }
  ImGui::EndCombo();
}

void draw_text(Ui& ui, const Parameter& p, const std::string& shown, float width) {
  const std::string id = fmt::format("parameters/{}/text", p.name);
  std::string text = ui.studio.document().texts.contains(p.name) ? shown : "";
  const std::string before = text;
  if (!text_field(ui, id, text, width, shown.c_str()) || text == before) return;
  if (text.empty()) {
    ui.studio.edit(fmt::format("reset {}", p.name), "",
                   [&](const Document& d) { return Result<Document>(without_value(d, p.name)); });
    return;
  }
  std::vector<std::string> all;
  for (const std::string_view part : p.repeats ? params::split(text, ' ') : std::vector<std::string_view>{text})
    if (!part.empty()) all.emplace_back(part);
  if (!ui.studio.edit(fmt::format("set {}", p.name), "",
                      [&](const Document& d) { return with_values(d, p.name, all); }))
    refuse_text(ui, id, text, ui.studio.problem());
}

std::string shown_text(const Ui& ui, const Parameter& p) {
  const auto list = ui.studio.document().list(p.name);
  if (list.empty()) return default_text(ui, p);
  std::string all;
  for (const std::string& one : list) all += (all.empty() ? "" : " ") + one;
  return all;
}

void draw_value(Ui& ui, const Parameter& p, const std::string& shown, float width) {
  if (p.kind == Kind::Real || p.kind == Kind::Integer) draw_number(ui, p, shown, width);
  if (p.kind == Kind::Choice) draw_choice(ui, p, shown, width);
  if (p.kind == Kind::Text) draw_text(ui, p, shown, width);
  if (p.kind == Kind::Switch) {
    bool on = shown == "on";
    if (ImGui::Checkbox("##value", &on)) set(ui, p, on ? "on" : "off", "");
  }
}

}  // namespace

std::string label_of(const Parameter& p) {
  std::string label(p.name == "fnumber" ? "f-number" : p.name == "focal" ? "focal length" : p.name);
  if (p.name != "fnumber") std::replace(label.begin(), label.end(), '-', ' ');
  // The unit of a text is the command line's word for how it is written.
  if ((p.kind != Kind::Real && p.kind != Kind::Integer) || p.unit.empty() || p.unit == "N") return label;
  std::string unit(p.unit == "um" ? "\u00b5m" : p.unit);
  if (unit == "PERIODS" || unit == "SECONDS" || unit == "STOPS")
    std::transform(unit.begin(), unit.end(), unit.begin(), [](char c) { return static_cast<char>(std::tolower(c)); });
  return label + "  " + unit;
}

void draw_parameter(Ui& ui, const Parameter& p, float label_width) {
  ImGui::PushID(p.name.data());
  const bool given = ui.studio.document().texts.contains(p.name);
  ImGui::AlignTextToFramePadding();
  fitting_text(label_of(p), scaled(label_width), given ? colours::text() : colours::dim());
  tip(fmt::format("{}\n--{}", p.help, p.name).c_str());
  ImGui::SameLine(ImGui::GetCursorStartPos().x + scaled(label_width + 10));
  const std::string shown = shown_text(ui, p);
  draw_value(ui, p, shown, ImGui::GetContentRegionAvail().x - scaled(56));
  ui.registry.record(fmt::format("parameters/{}", p.name), shown);
  if (may_have_keys(p)) {
    ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(50));
    key_button(ui, fmt::format("parameters/{}/key", p.name), {std::string(p.name), 0, {}});
  }
  if (given) {
    ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(24));
    if (button(ui, fmt::format("parameters/{}/reset", p.name), "\u00d7", "Back to the default", {scaled(24), 0}))
      ui.studio.edit(fmt::format("reset {}", p.name), "",
                     [&](const Document& d) { return Result<Document>(without_value(d, p.name)); });
  }
  ImGui::PopID();
}

void key_button(Ui& ui, const std::string& id, const TrackId& track) {
  const KeyedValue* keys = keys_of(ui.studio.document(), track);
  const int frame = ui.studio.view.frame;
  const bool here = keys != nullptr && std::any_of(keys->keys.begin(), keys->keys.end(),
                                                   [&](const Key& key) { return key.frame == frame; });
  const float height = ImGui::GetFrameHeight(), r = scaled(5);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushID(id.c_str());
  const bool pressed = ImGui::InvisibleButton("##key", {scaled(20), height});
  ImGui::PopID();
  ui.registry.record(id, here ? "key" : keys != nullptr ? "keys" : "");
  tip(here              ? "Remove the key of this frame"
      : keys != nullptr ? "Set a key at this frame"
                        : "Begin to change this over the frames: a key at this frame");
  const ImVec2 middle = {at.x + scaled(10), at.y + 0.5F * height};
  const ImVec2 points[] = {
      {middle.x, middle.y - r}, {middle.x + r, middle.y}, {middle.x, middle.y + r}, {middle.x - r, middle.y}};
  const ImU32 colour = ImGui::IsItemHovered() ? colours::text() : keys != nullptr ? colours::kAccent : colours::line();
  if (here)
    ImGui::GetWindowDrawList()->AddConvexPolyFilled(points, 4, colour);
  else
    ImGui::GetWindowDrawList()->AddPolyline(points, 4, colour, ImDrawFlags_Closed, scaled(1.2F));
  if (!pressed) return;
  ui.studio.edit(here ? "remove key" : "set key", "",
                 [&](const Document& d) { return here ? without_key(d, track, frame) : with_key(d, track, frame); });
}

}  // namespace contrejour::studio
