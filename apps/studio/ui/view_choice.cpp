// SPDX-License-Identifier: Apache-2.0
// The menu of view transforms: those of the studio, and the views of each display of the OpenColorIO configuration.
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "studio/ui/theme.h"
#include "studio/ui/viewport_parts.h"

namespace contrejour::studio {
namespace {

constexpr std::array kOwnViews = {"Film-like", "sRGB clipped", "False colour"};

void choose_view(Ui& ui, ViewTransform transform, const ColourViewName& colour = {}) {
  ui.studio.view.transform = transform;
  ui.studio.view.colour = colour;
  ui.studio.refresh_display();
}

void draw_views_of(Ui& ui, const ColourDisplay& display) {
  ImGui::TextDisabled("%s", display.name.c_str());
  for (const std::string& view : display.views) {
    const ColourViewName name{display.name, view};
    const bool chosen = ui.studio.view.transform == ViewTransform::Colour && ui.studio.view.colour == name;
    if (ImGui::Selectable(fmt::format("  {}##{}", view, display.name).c_str(), chosen))
      choose_view(ui, ViewTransform::Colour, name);
    ui.registry.record(fmt::format("viewport/transform/{}/{}", display.name, view));
  }
}

void draw_colour_views(Ui& ui) {
  const auto& views = ui.studio.colour_views();
  ImGui::Separator();
  if (!views) return ImGui::TextDisabled("reading the OpenColorIO configuration\u2026");
  const std::string name =
      views->config.empty() ? "built-in ACES" : std::filesystem::path(views->config).filename().string();
  ImGui::TextDisabled("OpenColorIO, %s", name.c_str());
  ui.registry.record("viewport/transform/config", views->config);
  if (!views->error.empty()) {
    ImGui::PushTextWrapPos(scaled(300));
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(colours::kBad), "%s", views->error.c_str());
    ImGui::PopTextWrapPos();
  }
  for (const ColourDisplay& display : views->displays) draw_views_of(ui, display);
}

}  // namespace

void draw_view_choice(Ui& ui, float width) {
  const View& view = ui.studio.view;
  const bool is_own = view.transform != ViewTransform::Colour;
  const std::string shown = is_own ? kOwnViews[static_cast<std::size_t>(view.transform)] : view.colour.view;
  const std::string value = is_own ? shown : fmt::format("{}/{}", view.colour.display, view.colour.view);
  ImGui::SetNextItemWidth(width);
  const bool is_open = ImGui::BeginCombo("##transform", shown.c_str(), ImGuiComboFlags_HeightLargest);
  ui.registry.record("viewport/transform", value);
  if (!is_open) {
    tip(is_own ? "How the scene's light becomes the screen's: highlights rolled off as in previews, clipped, stops as "
                 "colours, or a view of OpenColorIO ($OCIO, else ACES). The picture itself stays as it is."
               : fmt::format("OpenColorIO: {} on {}", view.colour.view, view.colour.display).c_str());
    return;
  }
  ui.studio.want_colour_views();
  for (std::size_t k = 0; k < kOwnViews.size(); ++k) {
    const auto transform = static_cast<ViewTransform>(k);
    if (ImGui::Selectable(kOwnViews[k], view.transform == transform)) choose_view(ui, transform);
    ui.registry.record(fmt::format("viewport/transform/{}", kOwnViews[k]));
  }
  draw_colour_views(ui);
  ImGui::EndCombo();
}

}  // namespace contrejour::studio
