// SPDX-License-Identifier: Apache-2.0
// Iris, starburst and dirt: their parameters, the pupil as the selected light's image sees it, and the point spread
// there.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "studio/ui/panels.h"
#include "studio/ui/parameter_widgets.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

struct IrisGroup {
  const char* title;
  std::array<const char*, 9> names;
};

// Parameters whose names begin so, in the order of the table.
constexpr std::array<IrisGroup, 3> kGroups = {{{"Iris", {"fnumber", "blade", "iris-"}},
                                               {"Starburst", {"starburst", "glare", "ringing"}},
                                               {"Dirt", {"dust", "scratch", "dirt-"}}}};
constexpr float kLabelWidth = 128;

bool belongs_to(const params::Parameter& p, const IrisGroup& group) {
  return std::any_of(group.names.begin(), group.names.end(),
                     [&](const char* name) { return name != nullptr && p.name.starts_with(name); });
}

void draw_parameters(Ui& ui) {
  for (const IrisGroup& group : kGroups) {
    ImGui::PushFont(medium_font());
    ImGui::TextUnformatted(group.title);
    ImGui::PopFont();
    for (const params::Parameter& p : params::all_parameters())
      if (belongs_to(p, group)) draw_parameter(ui, p, kLabelWidth);
    ImGui::Spacing();
  }
}

// A square picture with its caption below.
void draw_square(Ui& ui, const char* id, const Texture* texture, float side, const std::string& caption) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::BeginGroup();
  ImGui::Dummy({side, side});
  ui.registry.record(id, caption);
  if (texture != nullptr)
    list.AddImage(texture->id(), at, {at.x + side, at.y + side});
  else
    list.AddRectFilled(at, {at.x + side, at.y + side}, colours::kCanvas);
  list.AddRect(at, {at.x + side, at.y + side}, colours::line());
  fitting_text(caption, side, colours::dim());
  ImGui::EndGroup();
}

void draw_pictures(Ui& ui, TextureSet& textures) {
  const PointSpreadAnswer& spread = ui.studio.point_spread();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float side =
      std::max(scaled(60), std::min(0.5F * (room.x - gap), room.y - ImGui::GetTextLineHeightWithSpacing() - scaled(4)));
  const bool there = !spread.pupil.empty();
  const auto texture_of = [&](const char* name, const std::vector<std::uint32_t>& rgba, int pixels) -> const Texture* {
    return there ? &textures.get(name, ui.studio.point_spread_count(), pixels, pixels, rgba) : nullptr;
  };
  const std::size_t light = ui.studio.selection.light + 1;
  draw_square(ui, "iris/pupil", texture_of("pupil", spread.pupil, kPupilSide), side,
              there ? fmt::format("{:.1f} % clear", 100 * spread.open_fraction) : "Pupil");
  tip("The exit pupil as the light's image sees it: the iris, cut by the rims that vignette it, with dirt. The "
      "figure is the part of the iris's own opening that neither cuts off.");
  ImGui::SameLine();
  draw_square(ui, "iris/spread", texture_of("spread", spread.spread, kSpreadSide), side,
              !spread.error.empty() ? spread.error : fmt::format("{:.0f} \u00b5m wide", spread.width_um));
  tip(fmt::format("The point spread at light {}: the image of a point by diffraction, six decades of brightness. Drag "
                  "the light to see another place of the field.",
                  light)
          .c_str());
}

}  // namespace

void draw_iris_panel(Ui& ui, TextureSet& textures) {
  ui.studio.want_point_spread(true);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float left = std::clamp(0.46F * room.x, std::min(scaled(300), 0.6F * room.x), scaled(430));
  ImGui::BeginChild("##iris-parameters", {left, room.y});
  draw_parameters(ui);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("##iris-pictures", {0, room.y}, false, ImGuiWindowFlags_NoScrollbar);
  draw_pictures(ui, textures);
  ImGui::EndChild();
}

}  // namespace contrejour::studio
