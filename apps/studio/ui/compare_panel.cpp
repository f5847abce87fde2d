// SPDX-License-Identifier: Apache-2.0
// Snapshots, and how the picture differs from one of them: a wipe, the difference, figures.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

void draw_modes(Ui& ui) {
  static constexpr const char* kNames[] = {"Picture", "Wipe", "Difference"};
  static constexpr const char* kTips[] = {"The picture alone", "The snapshot to the left of the edge (W)",
                                          "How far the picture differs from the snapshot (D)"};
  CompareView compare = ui.studio.compare_view();
  for (int k = 0; k < 3; ++k) {
    const auto mode = static_cast<CompareMode>(k);
    const bool is_on = compare.mode == mode;
    if (k > 0) ImGui::SameLine(0, scaled(3));
    if (is_on) ImGui::PushStyleColor(ImGuiCol_Button, colours::kAccentDim);
    const bool pressed = button(ui, fmt::format("compare/mode/{}", k), kNames[k], kTips[k]);
    if (is_on) ImGui::PopStyleColor();
    if (pressed) compare.mode = mode;
  }
  ui.studio.set_compare(compare);
}

void draw_amount(Ui& ui) {
  CompareView compare = ui.studio.compare_view();
  if (compare.mode == CompareMode::Off) return;
  const bool wipes = compare.mode == CompareMode::Wipe;
  auto value = static_cast<float>(wipes ? 100 * compare.edge : compare.gain_stops);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(scaled(150));
  if (drag_bar("##amount", value, wipes ? 0.0F : -4.0F, wipes ? 100.0F : 16.0F,
               wipes ? "Edge %.0f %%" : "Gain %+.1f EV"))
    (wipes ? compare.edge : compare.gain_stops) = static_cast<double>(value) * (wipes ? 0.01 : 1.0);
  ui.registry.record("compare/amount", fmt::format("{}", value));
  tip(wipes ? "The edge can be dragged in the picture, too" : "Gain of the difference");
  ui.studio.set_compare(compare);
}

std::string figures_text(const Ui& ui) {
  const auto& figures = ui.studio.comparison();
  if (!figures) return ui.studio.snapshots().empty() ? "" : "pictures of different sizes, or not refined yet";
  const std::string psnr = figures->psnr_db ? fmt::format("{:.1f} dB", *figures->psnr_db) : std::string("equal");
  return fmt::format("PSNR {}    largest difference {:.3g}    flux R {:.4f}  G {:.4f}  B {:.4f}", psnr,
                     figures->max_abs_error, figures->flux_ratio[0], figures->flux_ratio[1], figures->flux_ratio[2]);
}

void draw_snapshot_buttons(Ui& ui, std::size_t index) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(scaled(6), 0));
  const bool restores = button(ui, fmt::format("compare/snapshot/{}/restore", index + 1), "Restore",
                               "Back to its settings, as a step that can be undone");
  ImGui::SameLine(0, scaled(4));
  const bool removes = button(ui, fmt::format("compare/snapshot/{}/remove", index + 1), "Remove", nullptr);
  ImGui::PopStyleVar();
  if (restores) ui.studio.restore_snapshot(index);
  if (removes) ui.studio.remove_snapshot(index);
}

void draw_snapshot(Ui& ui, std::size_t index, TextureSet& textures, float height) {
  const Snapshot snapshot = ui.studio.snapshots()[index];
  const Thumbnail& small = *snapshot.thumbnail;
  const float width = height * static_cast<float>(small.width) / static_cast<float>(std::max(1, small.height));
  const ImVec2 at = ImGui::GetCursorScreenPos(), end = {at.x + width, at.y + height};
  ImGui::BeginGroup();
  ImGui::PushID(static_cast<int>(index));
  const bool pressed = ImGui::InvisibleButton("##snapshot", {width, height});
  ImGui::PopID();
  const bool chosen = ui.studio.compare_view().snapshot == index;
  ui.registry.record(fmt::format("compare/snapshot/{}", index + 1), chosen ? "chosen" : "");
  tip("Compare the picture with this one");
  const auto stamp = reinterpret_cast<std::uintptr_t>(&small);
  const Texture& texture =
      textures.get(fmt::format("snapshot/{}", index), stamp, small.width, small.height, small.rgba);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(texture.id(), at, end);
  list.AddRect(at, end, chosen ? colours::kAccent : colours::line(), 0, 0, scaled(chosen ? 2 : 1));
  ImGui::TextUnformatted(snapshot.name.c_str());
  draw_snapshot_buttons(ui, index);
  ImGui::EndGroup();
  if (!pressed) return;
  CompareView compare = ui.studio.compare_view();
  compare.snapshot = index;
  ui.studio.set_compare(compare);
}

}  // namespace

void draw_compare_panel(Ui& ui, TextureSet& textures) {
  if (button(ui, "compare/take", "Take snapshot", "Keep this picture and its settings (C)")) ui.studio.take_snapshot();
  if (ui.studio.snapshots().empty()) {
    ImGui::Spacing();
    ImGui::PushTextWrapPos();
    ImGui::TextDisabled(
        "A snapshot keeps the refined picture with its settings. Change something, then wipe between the two, or look "
        "at their difference.");
    ImGui::PopTextWrapPos();
    return;
  }
  ImGui::SameLine(0, scaled(18));
  draw_modes(ui);
  draw_amount(ui);
  fitting_text(figures_text(ui), ImGui::GetContentRegionAvail().x, colours::dim());
  ui.registry.record("compare/figures", figures_text(ui));
  ImGui::BeginChild("##snapshots", {0, 0}, false, ImGuiWindowFlags_HorizontalScrollbar);
  const float below = 2 * ImGui::GetTextLineHeightWithSpacing() + scaled(18);
  const float height = std::clamp(ImGui::GetContentRegionAvail().y - below, scaled(48), scaled(150));
  for (std::size_t k = 0; k < ui.studio.snapshots().size(); ++k) {
    if (k > 0) ImGui::SameLine();
    draw_snapshot(ui, k, textures, height);
  }
  ImGui::EndChild();
}

}  // namespace contrejour::studio
