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

constexpr float kLabel = 104;  // width

void light_key(Ui& ui, std::size_t index, LightPart part) {
  ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(22));
  key_button(ui, fmt::format("lights/{}/{}/key", index + 1, name_of(part)), {"", index, part});
}

struct LightField {
  const char* name;
  const char* label;
  const char* hint;
  const char* help;
  std::string LightEntry::* member;
  LightPart part;
};

void label(const LightField& f) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", f.label);
  tip(f.help);
  ImGui::SameLine(scaled(kLabel));
}

// As wide as what is left of the line, but for its key.
void field(Ui& ui, std::size_t index, const LightField& f) {
  const auto& [name, label, hint, help, member, part] = f;
  LightEntry light = lights_of(ui.studio.document())[index];
  const std::string id = fmt::format("lights/{}/{}", index + 1, name);
  std::string text = light.*member;
  const bool is_entered = text_field(ui, id, text, ImGui::GetContentRegionAvail().x - scaled(26), hint);
  tip(help);
  light_key(ui, index, part);
  if (!is_entered || text == light.*member) return;
  light.*member = text;
  if (!ui.studio.edit(fmt::format("{} of light {}", name, index + 1), "",
                      [&](const Document& d) { return with_light(d, index, light); }))
    refuse_text(ui, id, text, ui.studio.problem());
}

void position_field(Ui& ui, std::size_t index) {
  const LightEntry light = lights_of(ui.studio.document())[index];
  auto across = static_cast<float>(100 * light.at.x), down = static_cast<float>(100 * light.at.y);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("position");
  tip("Where its image is: 0 % across and 0 % down is the frame's upper left corner, 100 % and 100 % the lower right "
      "one");
  ImGui::SameLine(scaled(kLabel));
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float width = 0.5F * (ImGui::GetContentRegionAvail().x - scaled(26) - gap);
  ImGui::PushID(static_cast<int>(index));
  const auto number = [&](const char* id, float& value, const char* format) {
    ImGui::SetNextItemWidth(width);
    const bool is_changed = ImGui::DragFloat(id, &value, 0.1F, -2000, 2000, format);
    if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
    return is_changed;
  };
  ImGui::BeginGroup();
  const bool is_moved_across = number("##across", across, "%.2f %% across");
  ImGui::SameLine(0, gap);
  const bool is_moved_down = number("##down", down, "%.2f %% down");
  ImGui::EndGroup();
  // The other coordinate is not rounded.
  const Vec2 to{is_moved_across ? 0.01 * static_cast<double>(across) : light.at.x,
                is_moved_down ? 0.01 * static_cast<double>(down) : light.at.y};
  if (is_moved_across || is_moved_down)
    ui.studio.edit(fmt::format("move light {}", index + 1), fmt::format("light/{}/at", index),
                   [&](const Document& d) { return with_light_at(d, index, to); });
  ImGui::PopID();
  ui.registry.record(fmt::format("lights/{}/position", index + 1), fmt::format("{},{}", to.x, to.y));
  light_key(ui, index, LightPart::Position);
}

// A bar to drag, where the value is a plain number, whose field next to it has that number.
void brightness_slider(Ui& ui, std::size_t index) {
  LightEntry light = lights_of(ui.studio.document())[index];
  const auto value = params::parse_real(light.value.empty() ? ui.studio.document().text("value") : light.value);
  if (!value || !(*value > 0)) return;
  auto amount = static_cast<float>(*value);
  ImGui::SetNextItemWidth(0.55F * (ImGui::GetContentRegionAvail().x - scaled(26)));
  ImGui::PushID(static_cast<int>(index) + 1000);
  if (drag_bar("##brightness", amount, 1, 1e7F, "", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoInput)) {
    light.value = fmt::format("{:.5g}", amount);
    ui.studio.edit(fmt::format("brightness of light {}", index + 1), fmt::format("light/{}/value", index),
                   [&](const Document& d) { return with_light(d, index, light); });
  }
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ImGui::PopID();
  ui.registry.record(fmt::format("lights/{}/brightness", index + 1), fmt::format("{}", amount));
  tip("Drag: brighter to the right, dimmer to the left; Alt: finer, Shift: coarser");
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
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
  static constexpr LightField kBrightness = {
      "value",
      "brightness",
      "1",
      "A number, the sum of the light's direct image, or with a unit: 12stops, 100000lx, 800cd, 1.6e9nits; or R,G,B",
      &LightEntry::value,
      LightPart::Value};
  label(kBrightness);
  brightness_slider(ui, index);
  field(ui, index, kBrightness);
  static constexpr LightField kFields[] = {
      {"colour", "colour", "D65: daylight", "D65, A, a temperature such as 3200K, led, sodium, R,G,B",
       &LightEntry::colour, LightPart::Colour},
      {"size", "size  deg", "0: a point", "Angular diameter in degrees; 0.53 for the sun; 0: a point",
       &LightEntry::size, LightPart::Size},
      {"distance", "distance  mm", "inf: as far as the sun", "From the first surface: 500 (mm), 2m, inf",
       &LightEntry::distance, LightPart::Distance}};
  for (const LightField& f : kFields) {
    label(f);
    field(ui, index, f);
  }
  return true;
}

void draw_plate_line(Ui& ui) {
  const Document& document = ui.studio.document();
  if (!document.has_plate()) return;
  std::string name = std::filesystem::path(document.plate.file).filename().string();
  if (const auto frames = ui.studio.plate_frames(); !frames.empty())
    name += fmt::format(", frames {}", frame_range_text(frames));
  ImGui::AlignTextToFramePadding();
  fitting_text(fmt::format("Plate: {}", name), ImGui::GetContentRegionAvail().x - scaled(70), colours::dim());
  ui.registry.record("lights/plate", document.plate.file);
  align_right({"Close"});
  if (button(ui, "lights/plate/close", "Close", "The flare on black again")) ui.studio.close_plate();
}

}  // namespace

void draw_lights_panel(Ui& ui) {
  if (button(ui, "lights/add", "Add light",
             "A light like the selected one, above the middle (L). A double-click in the picture adds it there."))
    ui.studio.add_light(kPlaceOfNewLight);
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
