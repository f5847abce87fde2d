// SPDX-License-Identifier: Apache-2.0
// The lights: position, brightness, colour, size, distance, each as the command line takes it.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "contrejour/expert/frame_range.h"
#include "contrejour/expert/parameter_text.h"
#include "studio/core/lights.h"
#include "studio/ui/panels.h"
#include "studio/ui/parameter_widgets.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

void light_key(Ui& ui, std::size_t index, LightPart part) {
  ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(22));
  key_button(ui, fmt::format("lights/{}/{}/key", index + 1, name_of(part)), {"", index, part});
}

struct LightField {
  const char* name;
  const char* hint;
  const char* help;
  std::string LightEntry::* member;
  LightPart part;
};

void field(Ui& ui, std::size_t index, const LightField& f) {
  const auto& [name, hint, help, member, part] = f;
  LightEntry light = lights_of(ui.studio.document())[index];
  const std::string id = fmt::format("lights/{}/{}", index + 1, name);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", name);
  tip(help);
  ImGui::SameLine(scaled(92));
  std::string text = light.*member;
  const bool is_entered = text_field(ui, id, text, ImGui::GetContentRegionAvail().x - scaled(26), hint);
  light_key(ui, index, part);
  if (!is_entered || text == light.*member) return;
  light.*member = text;
  if (!ui.studio.edit(fmt::format("{} of light {}", name, index + 1), "",
                      [&](const Document& d) { return with_light(d, index, light); }))
    refuse_text(ui, id, text, ui.studio.problem());
}

void position_field(Ui& ui, std::size_t index) {
  const LightEntry light = lights_of(ui.studio.document())[index];
  float uv[2] = {static_cast<float>(light.at.x), static_cast<float>(light.at.y)};
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("position");
  tip("u, v of its image: 0, 0 is the frame's top left corner and 1, 1 its bottom right one");
  ImGui::SameLine(scaled(92));
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - scaled(26));
  ImGui::PushID(static_cast<int>(index));
  if (ImGui::DragFloat2("##position", uv, 0.001F, -20, 20, "%.4f"))
    ui.studio.edit(fmt::format("move light {}", index + 1), fmt::format("light/{}/at", index), [&](const Document& d) {
      return with_light_at(d, index, {static_cast<double>(uv[0]), static_cast<double>(uv[1])});
    });
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ImGui::PopID();
  ui.registry.record(fmt::format("lights/{}/position", index + 1), fmt::format("{},{}", uv[0], uv[1]));
  light_key(ui, index, LightPart::Position);
}

// A slider over ten stops to each side, where the value is a plain number.
void brightness_slider(Ui& ui, std::size_t index) {
  LightEntry light = lights_of(ui.studio.document())[index];
  const auto value = params::parse_real(light.value.empty() ? ui.studio.document().text("value") : light.value);
  if (!value || !(*value > 0)) return;
  auto amount = static_cast<float>(*value);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("brightness");
  ImGui::SameLine(scaled(92));
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - scaled(26));
  ImGui::PushID(static_cast<int>(index) + 1000);
  if (ImGui::SliderFloat("##brightness", &amount, 1, 1e7F, "%.4g", ImGuiSliderFlags_Logarithmic)) {
    light.value = fmt::format("{:.5g}", amount);
    ui.studio.edit(fmt::format("brightness of light {}", index + 1), fmt::format("light/{}/value", index),
                   [&](const Document& d) { return with_light(d, index, light); });
  }
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ImGui::PopID();
  ui.registry.record(fmt::format("lights/{}/brightness", index + 1), fmt::format("{}", amount));
}

// Whether the light is still there.
bool draw_light(Ui& ui, std::size_t index) {
  const bool selected = ui.studio.selection.light == index;
  const std::string id = fmt::format("lights/{}", index + 1);
  ImGui::PushFont(medium_font());
  if (ImGui::Selectable(fmt::format("Light {}##{}", index + 1, id).c_str(), selected, 0,
                        {ImGui::GetContentRegionAvail().x - scaled(76), 0}))
    ui.studio.select_light(index);
  ImGui::PopFont();
  ui.registry.record(id, selected ? "selected" : "");
  ImGui::SameLine();
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(scaled(8), 0));
  const bool removes = button(ui, id + "/remove", "Remove", "Remove this light (Delete)");
  ImGui::PopStyleVar();
  if (removes && ui.studio.edit(fmt::format("remove light {}", index + 1), "",
                                [&](const Document& d) { return without_light(d, index); }))
    return false;
  position_field(ui, index);
  brightness_slider(ui, index);
  static constexpr LightField kFields[] = {
      {"value", "1", "The sum of its direct image, or R,G,B, or 12stops, 100000lx, 800cd, 1.6e9nits",
       &LightEntry::value, LightPart::Value},
      {"colour", "D65", "D65, A, a temperature such as 3200K, led, sodium, R,G,B", &LightEntry::colour,
       LightPart::Colour},
      {"size", "0", "Angular diameter in degrees; 0.53 for the sun; 0: a point", &LightEntry::size, LightPart::Size},
      {"distance", "inf", "From the first surface: 500 (mm), 2m, inf", &LightEntry::distance, LightPart::Distance}};
  for (const LightField& f : kFields) field(ui, index, f);
  return true;
}

void draw_plate_line(Ui& ui) {
  const Document& document = ui.studio.document();
  if (!document.has_plate()) return;
  std::string name = std::filesystem::path(document.plate.file).filename().string();
  if (const auto frames = ui.studio.plate_frames(); !frames.empty())
    name += fmt::format(", frames {}", frame_range_text(frames));
  ImGui::AlignTextToFramePadding();
  fitting_text(fmt::format("Plate: {}", name), ImGui::GetContentRegionAvail().x - scaled(70), colours::kDim);
  ui.registry.record("lights/plate", document.plate.file);
  align_right({"Close"});
  if (button(ui, "lights/plate/close", "Close", "The flare on black again")) ui.studio.close_plate();
}

}  // namespace

void draw_lights_panel(Ui& ui) {
  const std::size_t count = lights_of(ui.studio.document()).size();
  if (button(ui, "lights/add", "Add light",
             "A light like the selected one, in the middle (or double-click in the picture)")) {
    LightEntry light =
        count > 0 ? lights_of(ui.studio.document())[std::min(ui.studio.selection.light, count - 1)] : LightEntry{};
    light.at = {0.5, 0.4};
    if (ui.studio.edit("add light", "", [&](const Document& d) { return with_new_light(d, light); }))
      ui.studio.select_light(count);
  }
  ImGui::SameLine();
  if (button(ui, "lights/detect", "From plate", "Lights where the plate is bright, in place of these (Shift+L)"))
    ui.studio.detect_lights();
  draw_plate_line(ui);
  ImGui::BeginChild("##lights");
  for (std::size_t k = 0; k < lights_of(ui.studio.document()).size(); ++k) {
    ImGui::Spacing();
    if (!draw_light(ui, k)) break;
    ImGui::Spacing();
    ImGui::Separator();
  }
  ImGui::EndChild();
}

}  // namespace contrejour::studio
