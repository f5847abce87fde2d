// SPDX-License-Identifier: Apache-2.0
// Looks by their thumbnails, all of the same scene: bundled ones and the user's own. A click takes one over.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr float kLeastTile = 128;

void draw_tile_picture(Ui& ui, const Look& look, TextureSet& textures, ImVec2 min, ImVec2 max) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto found = ui.studio.thumbnails().find(look.source);
  if (found == ui.studio.thumbnails().end() || found->second->rgba.empty()) {
    list.AddRectFilled(min, max, colours::kCanvas, scaled(4));
    const char* text = "rendering\u2026";
    list.AddText({0.5F * (min.x + max.x - text_width(text)), 0.5F * (min.y + max.y - ImGui::GetTextLineHeight())},
                 colours::dim(), text);
    return;
  }
  const Thumbnail& thumbnail = *found->second;
  const auto stamp = reinterpret_cast<std::uintptr_t>(&thumbnail);
  const Texture& texture =
      textures.get("look/" + look.source, stamp, thumbnail.width, thumbnail.height, thumbnail.rgba);
  list.AddImageRounded(texture.id(), min, max, {0, 0}, {1, 1}, IM_COL32_WHITE, scaled(4));
}

void take_look(Ui& ui, const Look& look) {
  ui.studio.edit(fmt::format("look {}", look.name), "",
                 [&](const Document& d) { return document_with_preset(d, look.source); });
}

void draw_tile(Ui& ui, const Look& look, TextureSet& textures, float width) {
  const float height = width * kThumbnailHeight / kThumbnailWidth, line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushID(look.source.c_str());
  const bool pressed = ImGui::InvisibleButton("##look", {width, height + line + scaled(4)});
  ImGui::PopID();
  const auto thumbnail = ui.studio.thumbnails().find(look.source);
  ui.registry.record("looks/" + look.name, thumbnail != ui.studio.thumbnails().end() ? "rendered" : "");
  const bool hovered = ImGui::IsItemHovered();
  tip(fmt::format("{}\n{}", look.description.empty() ? look.source : look.description,
                  look.lens.empty() ? "" : "Lens: " + look.lens)
          .c_str());
  draw_tile_picture(ui, look, textures, at, {at.x + width, at.y + height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRect(at, {at.x + width, at.y + height}, hovered ? colours::kAccent : colours::line(), scaled(4), 0,
               scaled(hovered ? 2 : 1));
  const ImVec2 text = {at.x + scaled(2), at.y + height + scaled(3)};
  list.AddText(text, hovered ? colours::text() : colours::dim(), fitted(look.name, width - scaled(2)).c_str());
  if (pressed) take_look(ui, look);
}

void draw_tiles(Ui& ui, bool are_own, TextureSet& textures) {
  const float room = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
  const int columns = std::max(1, static_cast<int>((room + gap) / (scaled(kLeastTile) + gap)));
  const float width = (room - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
  int k = 0;
  for (const Look& look : std::vector<Look>(ui.studio.looks())) {
    if (look.is_own != are_own) continue;
    if (k++ % columns != 0) ImGui::SameLine();
    draw_tile(ui, look, textures, width);
  }
  if (k == 0) ImGui::TextDisabled("Save the settings at hand to have a look of your own.");
}

void draw_heading(const char* text) {
  ImGui::Spacing();
  ImGui::PushFont(medium_font());
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

void draw_saving(Ui& ui) {
  const float button_width = scaled(104);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button_width - ImGui::GetStyle().ItemSpacing.x);
  const bool entered = ImGui::InputTextWithHint("##name", "Name of a look of your own", &ui.state.look_name,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  ui.registry.record("looks/name", ui.state.look_name);
  ImGui::SameLine();
  const bool saves =
      button(ui, "looks/save", "Save look", "All settings but lights, size and exposure", {button_width, 0});
  if ((saves || entered) && ui.studio.save_look(ui.state.look_name)) ui.state.look_name.clear();
}

}  // namespace

void draw_looks_panel(Ui& ui, TextureSet& textures) {
  if (ui.studio.thumbnails().empty() && ui.studio.is_idle()) ui.studio.want_thumbnails();
  draw_saving(ui);
  ImGui::BeginChild("##looks");
  draw_heading("Bundled");
  draw_tiles(ui, false, textures);
  draw_heading("Your own");
  draw_tiles(ui, true, textures);
  ImGui::EndChild();
}

}  // namespace contrejour::studio
