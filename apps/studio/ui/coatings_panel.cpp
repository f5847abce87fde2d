// SPDX-License-Identifier: Apache-2.0
// Reflectance of each coated surface over wavelength at three angles, its colour, and another coating for it.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/expert/coating.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/parameter_text.h"
#include "studio/core/coating_curves.h"
#include "studio/ui/panels.h"
#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr std::array<ImU32, 3> kAngleColours = {IM_COL32(240, 173, 78, 255), IM_COL32(122, 199, 140, 255),
                                                IM_COL32(102, 178, 255, 255)};
constexpr std::array<const char*, 9> kDesigns = {"none",        "quarter-wave",         "v-coat",
                                                 "w-coat",      "quarter-half-quarter", "broadband-4",
                                                 "broadband-5", "broadband-6",          "broadband-7"};

const SurfaceState* selected_surface(const Ui& ui) {
  const auto& surfaces = ui.studio.lens().surfaces;
  const int number = ui.studio.selection.surface;
  if (number < 1 || number > static_cast<int>(surfaces.size())) return nullptr;
  return &surfaces[static_cast<std::size_t>(number) - 1];
}

std::string name_of(const Coating& coating) { return coating.name.empty() ? describe(coating) : coating.name; }

bool reflects(const SurfaceState& s) { return s.kind == SurfaceKind::Refracting && !(s.before == s.after); }

void draw_list(Ui& ui) {
  ImGui::Dummy({1, scaled(1)});
  const auto& surfaces = ui.studio.lens().surfaces;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (!reflects(surfaces[k])) continue;
    const int number = static_cast<int>(k) + 1;
    const std::string id = fmt::format("coatings/{}", number);
    const Rgb colour = reflected_rgb(surfaces[k]);
    const double brightest = std::fmax(1e-9, std::fmax(colour[0], std::fmax(colour[1], colour[2])));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(id.c_str());
    if (ImGui::Selectable("##surface", ui.studio.selection.surface == number)) ui.studio.selection.surface = number;
    ImGui::PopID();
    ui.registry.record(id, name_of(surfaces[k].coating));
    bring_into_sight(ui, number, ui.state.coating_in_sight);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float line = ImGui::GetTextLineHeight();
    list.AddRectFilled({at.x + scaled(26), at.y + scaled(1)}, {at.x + scaled(44), at.y + line - scaled(1)},
                       display_colour(colour, brightest), scaled(3));
    list.AddText(at, colours::kText, fmt::format("{}", number).c_str());
    list.AddText({at.x + scaled(54), at.y}, colours::kText,
                 fmt::format("{:.2f} %", 100 * mean_reflectance(surfaces[k])).c_str());
    ImGui::SameLine(scaled(112));
    fitting_text(name_of(surfaces[k].coating), ImGui::GetContentRegionMax().x - scaled(116), colours::kDim);
  }
}

void draw_axes(ImDrawList& list, ImVec2 min, ImVec2 max, double top) {
  for (int percent = 0; percent <= 4; ++percent) {
    const float y = max.y - (max.y - min.y) * static_cast<float>(percent) / 4;
    list.AddLine({min.x, y}, {max.x, y}, IM_COL32(255, 255, 255, percent == 0 ? 60 : 20));
    const std::string text = fmt::format("{:.3g} %", 100 * top * percent / 4);
    const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
    list.AddText(small_font(), small_font()->FontSize, {min.x - size.x - scaled(6), y - 0.5F * size.y}, colours::kDim,
                 text.c_str());
  }
  for (int lambda = 400; lambda <= 700; lambda += 50) {
    const float x =
        min.x + (max.x - min.x) * static_cast<float>((lambda - kFirstCurve_nm) / (kLastCurve_nm - kFirstCurve_nm));
    list.AddLine({x, min.y}, {x, max.y}, IM_COL32(255, 255, 255, 16));
    const std::string text = fmt::format("{}", lambda);
    const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
    list.AddText(small_font(), small_font()->FontSize, {x - 0.5F * size.x, max.y + scaled(3)}, colours::kDim,
                 text.c_str());
  }
}

void draw_curves(ImDrawList& list, const ReflectanceCurves& curves, ImVec2 min, ImVec2 max, double top) {
  std::array<ImVec2, kCurvePoints> points;
  for (std::size_t a = 0; a < curves.reflectance.size(); ++a) {
    for (std::size_t k = 0; k < points.size(); ++k)
      points[k] = {min.x + (max.x - min.x) * static_cast<float>(k) / static_cast<float>(points.size() - 1),
                   max.y - (max.y - min.y) * static_cast<float>(std::min(1.0, curves.reflectance[a][k] / top))};
    list.AddPolyline(points.data(), static_cast<int>(points.size()), kAngleColours[a], 0, scaled(1.8F));
  }
}

double rounded_up(double value) {
  for (const double top : {0.005, 0.01, 0.02, 0.04, 0.1, 0.2, 0.4, 1.0})
    if (value <= top) return top;
  return 1.0;
}

void draw_plot(Ui& ui, const SurfaceState& surface) {
  const ImVec2 start = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const ImVec2 min = {start.x + scaled(52), start.y + scaled(8)};
  const ImVec2 max = {start.x + room.x - scaled(14), start.y + room.y - scaled(24)};
  ImGui::Dummy(room);
  ui.registry.record("coatings/plot");
  if (max.x - min.x < 20 || max.y - min.y < 20) return;
  const ReflectanceCurves curves = reflectance_curves(surface);
  const double top = rounded_up(curves.largest);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_axes(list, min, max, top);
  draw_curves(list, curves, min, max, top);
  float x = max.x - scaled(150);
  for (std::size_t a = 0; a < kCurveAngles_deg.size(); ++a) {
    const std::string text = fmt::format("{:.0f}\u00b0", kCurveAngles_deg[a]);
    list.AddText({x, min.y}, kAngleColours[a], text.c_str());
    x += scaled(50);
  }
}

bool set_coating(Ui& ui, int surface, const std::string& coating, const std::string& key) {
  return ui.studio.edit(fmt::format("coat surface {}", surface), key,
                        [&](const Document& d) { return with_surface_coating(d, surface, coating); });
}

void draw_coating_controls(Ui& ui, const SurfaceState& surface) {
  const int number = ui.studio.selection.surface;
  ImGui::AlignTextToFramePadding();
  ImGui::Text("Surface %d", number);
  ImGui::SameLine();
  const float room = ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(std::min(scaled(180), 0.34F * room));
  const std::string current = name_of(surface.coating);
  ui.registry.record("coatings/label");
  if (ImGui::BeginCombo("##design", current.c_str())) {
    for (const char* design : kDesigns) {
      if (ImGui::Selectable(design)) set_coating(ui, number, design, "");
      ui.registry.record(fmt::format("coatings/design/{}", design));
    }
    ImGui::EndCombo();
  }
  ui.registry.record("coatings/design", current);
  ImGui::SameLine();
  std::string typed = coating_of_surface(ui.studio.document(), number);
  if (text_field(ui, "coatings/text", typed, std::min(scaled(190), 0.36F * room), "v-coat:550") && !typed.empty())
    if (!set_coating(ui, number, typed, "")) refuse_text(ui, "coatings/text", typed, ui.studio.problem());
  ImGui::SameLine();
  const auto wavelength = design_wavelength_nm(ui.studio.document(), number);
  if (!wavelength) return;
  auto lambda = static_cast<float>(*wavelength);
  ImGui::SetNextItemWidth(std::min(scaled(170), 0.3F * room));
  if (ImGui::SliderFloat("##lambda", &lambda, 380, 760, "%.0f nm"))
    set_coating(ui, number,
                with_design_wavelength(coating_of_surface(ui.studio.document(), number), static_cast<double>(lambda)),
                "coatings/lambda");
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ui.registry.record("coatings/lambda", fmt::format("{:.1f}", lambda));
}

void select_first_glass(Ui& ui) {
  const SurfaceState* surface = selected_surface(ui);
  if (surface != nullptr && reflects(*surface)) return;
  const auto& surfaces = ui.studio.lens().surfaces;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (!reflects(surfaces[k])) continue;
    ui.studio.selection.surface = static_cast<int>(k) + 1;
    return;
  }
}

}  // namespace

void draw_coatings_panel(Ui& ui) {
  select_first_glass(ui);
  ImGui::BeginChild("##surfaces", {std::min(scaled(330), 0.38F * ImGui::GetContentRegionAvail().x), 0});
  draw_list(ui);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("##plot", {0, 0});
  if (const SurfaceState* surface = selected_surface(ui)) {
    draw_coating_controls(ui, *surface);
    draw_plot(ui, *surface);
  }
  ImGui::EndChild();
}

}  // namespace contrejour::studio
