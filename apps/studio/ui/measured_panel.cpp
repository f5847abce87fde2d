// SPDX-License-Identifier: Apache-2.0
// A measured flare: its kymograph, in which the angle is chosen; the picture there; the ghosts' parameters over the
// angle.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr std::array<ImU32, 6> kCurveColours = {IM_COL32(240, 173, 78, 255),  IM_COL32(102, 178, 255, 255),
                                                IM_COL32(122, 199, 140, 255), IM_COL32(222, 132, 200, 255),
                                                IM_COL32(226, 226, 130, 255), IM_COL32(170, 150, 240, 255)};

void draw_small_text(ImDrawList& list, ImVec2 at, const std::string& text, bool to_the_left) {
  const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
  list.AddText(small_font(), small_font()->FontSize, {to_the_left ? at.x - size.x : at.x, at.y}, colours::dim(),
               text.c_str());
}

// id: "kymograph", or "photographs" for that of the photographs.
void draw_kymograph(Ui& ui, TextureSet& textures, const char* id,
                    const std::shared_ptr<const std::vector<std::uint32_t>>& rows, ImVec2 size) {
  const MeasuredAnswer& measured = ui.studio.measured();
  const ImVec2 at = ImGui::GetCursorScreenPos(), end = {at.x + size.x, at.y + size.y};
  ImGui::InvisibleButton(id, size);
  ui.registry.record(fmt::format("measured/{}", id), fmt::format("{:.3f}", measured.angle_deg));
  tip("A row for each angle of the light, from left of the axis to right of it: ghosts are slanted lines. Drag to "
      "choose "
      "the angle.");
  const double most = largest_angle_deg(*measured.flare);
  if (ImGui::IsItemActive()) {
    const double part = std::clamp(static_cast<double>((ImGui::GetIO().MousePos.y - at.y) / size.y), 0.0, 1.0);
    ui.studio.choose_measured_angle(most * (2 * part - 1));
  }
  const auto stamp = reinterpret_cast<std::uintptr_t>(rows.get());
  const Texture& texture = textures.get(id, stamp, kKymographWidth, kKymographHeight, *rows);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(texture.id(), at, end);
  list.AddRect(at, end, colours::line());
  const float y = at.y + size.y * static_cast<float>(0.5 * (measured.angle_deg / std::max(most, 1e-9) + 1));
  list.AddLine({at.x, y}, {end.x, y}, colours::kSelected, scaled(1.5F));
}

void draw_measured_picture(Ui& ui, TextureSet& textures, const std::string& id, const std::string& label,
                           std::span<const std::uint32_t> codes, ImVec2 size) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), end = {at.x + size.x, at.y + size.y};
  ImGui::Dummy(size);
  ui.registry.record("measured/" + id, label);
  const Texture& texture =
      textures.get("measured/" + id, ui.studio.measured_count(), kMeasuredWidth, kMeasuredHeight, codes);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(texture.id(), at, end);
  list.AddRect(at, end, colours::line());
  draw_small_text(list, {at.x + scaled(5), at.y + scaled(2)}, label, false);
}

struct CurveRange {
  double least = 0, most = 0, angle = 1e-9;
};

CurveRange range_of(const std::vector<MeasuredCurve>& curves) {
  CurveRange range;
  for (const MeasuredCurve& curve : curves)
    for (const Vec2 p : curve.points) {
      range.least = std::min(range.least, p.y);
      range.most = std::max(range.most, p.y);
      range.angle = std::max(range.angle, p.x);
    }
  if (!(range.most > range.least)) range.most = range.least + 1;
  return range;
}

void draw_ghost_curves(Ui& ui, ImVec2 size) {
  const MeasuredAnswer& measured = ui.studio.measured();
  const auto curves = curves_of(*measured.flare, kGhostCurves[static_cast<std::size_t>(ui.state.measured_curve)]);
  const CurveRange range = range_of(curves);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  ui.registry.record("measured/curves", fmt::format("{}", curves.size()));
  const ImVec2 min = {at.x + scaled(48), at.y + scaled(6)},
               max = {at.x + size.x - scaled(6), at.y + size.y - scaled(20)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto screen = [&](Vec2 p) {
    return ImVec2{min.x + (max.x - min.x) * static_cast<float>(p.x / range.angle),
                  max.y - (max.y - min.y) * static_cast<float>((p.y - range.least) / (range.most - range.least))};
  };
  list.AddRect(min, max, colours::line());
  draw_small_text(list, {min.x - scaled(5), min.y - scaled(2)}, fmt::format("{:.3g}", range.most), true);
  draw_small_text(list, {min.x - scaled(5), max.y - scaled(12)}, fmt::format("{:.3g}", range.least), true);
  draw_small_text(list, {min.x, max.y + scaled(3)}, "0\u00b0", false);
  draw_small_text(list, {max.x, max.y + scaled(3)}, fmt::format("{:.3g}\u00b0", range.angle), true);
  const float now = screen({std::min(range.angle, std::fabs(measured.angle_deg)), 0}).x;
  list.AddLine({now, min.y}, {now, max.y}, colours::kSelected, 1);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    std::vector<ImVec2> points;
    for (const Vec2 p : curves[k].points) points.push_back(screen(p));
    list.AddPolyline(points.data(), static_cast<int>(points.size()), kCurveColours[k % kCurveColours.size()], 0,
                     scaled(1.6F));
  }
}

void draw_choice_of_curve(Ui& ui) {
  std::array<const char*, kGhostCurves.size()> names{};
  for (std::size_t k = 0; k < names.size(); ++k) names[k] = name_of(kGhostCurves[k]);
  ImGui::SetNextItemWidth(scaled(120));
  ImGui::Combo("##curve", &ui.state.measured_curve, names.data(), static_cast<int>(names.size()));
  ui.registry.record("measured/curve", names[static_cast<std::size_t>(ui.state.measured_curve)]);
  tip("The parameter of the ghosts, each in a colour of its own, over the angle of the light");
}

// The photograph of a station over the fit in its light, both kymographs, the residual.
void draw_photographs(Ui& ui, TextureSet& textures, ImVec2 room) {
  const MeasuredAnswer& measured = ui.studio.measured();
  const MeasuredPhotograph& photograph = *measured.photograph;
  const ImVec2 gap = ImGui::GetStyle().ItemSpacing;
  const float height = std::max(scaled(30), std::min(0.5F * (room.y - gap.y - scaled(2)), 0.2F * room.x));
  const float width = height * kMeasuredWidth / kMeasuredHeight;
  const auto column = [&](const auto& upper, const auto& lower) {
    ImGui::BeginGroup();
    upper();
    lower();
    ImGui::EndGroup();
    ImGui::SameLine();
  };
  const auto picture = [&](const char* id, const std::string& label, const std::vector<std::uint32_t>& codes) {
    return [&, id, label] { draw_measured_picture(ui, textures, id, label, codes, {width, height}); };
  };
  column([&] { draw_kymograph(ui, textures, "photographs", photograph.kymograph, {width, height}); },
         [&] { draw_kymograph(ui, textures, "kymograph", measured.kymograph, {width, height}); });
  column(picture("captured", fmt::format("photograph {}", photograph.station + 1), photograph.captured),
         picture("fitted", "fit", photograph.fitted));
  column(picture("residual", "residual", photograph.residual), [&] {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    const std::string text = fmt::format("{} of {} photographs of {}", photograph.read, photograph.count,
                                         std::filesystem::path(measured.sweep).filename().string());
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
    ui.registry.record("measured/read", text);
  });
}

// The angle at which the light stands, and what to show beside it.
void draw_measured_header(Ui& ui) {
  const MeasuredAnswer& measured = ui.studio.measured();
  ImGui::AlignTextToFramePadding();
  const std::string title = fmt::format(
      "{}: {} ghost{}, light at {:+.2f}\u00b0", measured.flare->name.empty() ? measured.file : measured.flare->name,
      measured.flare->ghosts.size(), measured.flare->ghosts.size() == 1 ? "" : "s", measured.angle_deg);
  fitting_text(title, ImGui::GetContentRegionAvail().x - scaled(264), colours::text());
  ui.registry.record("measured/title", title);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(250));
  if (button(ui, "measured/sweep", "Photographs\u2026",
             "The folder of the merged photographs that this flare was learned from: each beside the fit, and what the "
             "fit leaves",
             {scaled(120), 0}))
    open_dialog(ui, Dialog::OpenSweep, measured.sweep);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - scaled(122));
  draw_choice_of_curve(ui);
}

}  // namespace

void draw_measured_panel(Ui& ui, TextureSet& textures) {
  const MeasuredAnswer& measured = ui.studio.measured();
  if (!measured.flare) {
    ImGui::PushTextWrapPos();
    ImGui::TextDisabled(
        "%s", measured.error.empty()
                  ? "Open a flare that was measured from photographs of a lens (a .flare.toml file), or drop it here."
                  : measured.error.c_str());
    ImGui::PopTextWrapPos();
    return;
  }
  draw_measured_header(ui);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = std::max(scaled(60), (room.x - 2 * gap) / 3);
  const float height = std::max(scaled(40), std::min(room.y - scaled(2), width * kMeasuredHeight / kMeasuredWidth));
  if (measured.photograph) {
    draw_photographs(ui, textures, room);
  } else {
    draw_kymograph(ui, textures, "kymograph", measured.kymograph, {width, height});
    ImGui::SameLine();
    draw_measured_picture(ui, textures, "picture", "", measured.picture,
                          {height * kMeasuredWidth / kMeasuredHeight, height});
    ImGui::SameLine();
  }
  draw_ghost_curves(ui, {std::max(scaled(60), ImGui::GetContentRegionAvail().x), room.y - scaled(2)});
}

}  // namespace contrejour::studio
