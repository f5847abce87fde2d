// SPDX-License-Identifier: Apache-2.0
// Every parameter of the one table, by its groups. A parameter that is new in the table appears here by itself.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

using params::Kind;
using params::Parameter;

constexpr double kWidestSlider = 1000.0;  // a wider range is dragged, not slid

// Lights have a panel of their own, ghosts and coatings of surfaces too; threads are the machine's.
bool has_panel_of_its_own(const Parameter& p) {
  return p.name == "light" || p.name == "light-at" || p.name == "threads" || p.group == "Light detection";
}

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
  ImGui::SetNextItemWidth(width);
  const float speed = whole ? 0.1F : std::max(1e-4F, 0.005F * std::fabs(number));
  const bool changed =
      slides && !whole && p.maximum - p.minimum <= 100
          ? ImGui::SliderFloat("##value", &number, low, high, format, ImGuiSliderFlags_AlwaysClamp)
          : ImGui::DragFloat("##value", &number, speed, low, high, format, ImGuiSliderFlags_AlwaysClamp);
  const std::string key = fmt::format("parameter/{}", p.name);
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

void draw_parameter(Ui& ui, const Parameter& p) {
  ImGui::PushID(p.name.data());
  const bool given = ui.studio.document().texts.contains(p.name);
  ImGui::AlignTextToFramePadding();
  const std::string label =
      p.unit.empty() || p.kind == Kind::Text ? std::string(p.name) : fmt::format("{}  {}", p.name, p.unit);
  fitting_text(label, scaled(162), given ? colours::kText : colours::kDim);
  if (ImGui::IsItemHovered()) tip(std::string(p.help).c_str());
  ImGui::SameLine(scaled(172));
  const std::string shown = shown_text(ui, p);
  draw_value(ui, p, shown, ImGui::GetContentRegionAvail().x - scaled(32));
  ui.registry.record(fmt::format("parameters/{}", p.name), shown);
  if (given) {
    ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(24));
    if (button(ui, fmt::format("parameters/{}/reset", p.name), "\u00d7", "Back to the default", {scaled(24), 0}))
      ui.studio.edit(fmt::format("reset {}", p.name), "",
                     [&](const Document& d) { return Result<Document>(without_value(d, p.name)); });
  }
  ImGui::PopID();
}

std::vector<std::string_view> groups() {
  std::vector<std::string_view> names;
  for (const Parameter& p : params::all_parameters())
    if (!has_panel_of_its_own(p) && std::find(names.begin(), names.end(), p.group) == names.end())
      names.push_back(p.group);
  return names;
}

bool fits_filter(const Parameter& p, const std::string& filter) {
  return filter.empty() || p.name.find(filter) != std::string_view::npos ||
         p.help.find(filter) != std::string_view::npos;
}

}  // namespace

void draw_parameters_panel(Ui& ui) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##filter", "Find a parameter", &ui.state.parameter_filter);
  ui.registry.record("parameters/filter", ui.state.parameter_filter);
  ImGui::BeginChild("##parameters");
  for (const std::string_view group : groups()) {
    ImGui::PushFont(medium_font());
    const bool open = ImGui::CollapsingHeader(std::string(group).c_str(), ImGuiTreeNodeFlags_DefaultOpen);
    ImGui::PopFont();
    if (!open) continue;
    for (const Parameter& p : params::all_parameters())
      if (p.group == group && !has_panel_of_its_own(p) && fits_filter(p, ui.state.parameter_filter))
        draw_parameter(ui, p);
  }
  ImGui::EndChild();
}

}  // namespace contrejour::studio
