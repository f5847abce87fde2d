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

constexpr float kNameAt = 118;  // in a row of the list

void draw_list_row(Ui& ui, int number, const SurfaceState& surface) {
  const std::string id = fmt::format("coatings/{}", number), name = name_of(surface.coating);
  const Rgb colour = reflected_rgb(surface);
  const double brightest = std::fmax(1e-9, std::fmax(colour[0], std::fmax(colour[1], colour[2])));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushID(id.c_str());
  if (ImGui::Selectable("##surface", ui.studio.selection.surface == number)) ui.studio.selection.surface = number;
  ImGui::PopID();
  const std::string shown = fitted(name, ImGui::GetContentRegionMax().x - scaled(kNameAt + 4));
  ui.registry.record(id, shown);
  const std::string share = fmt::format("{:.2f} %", 100 * luminous_reflectance(surface));
  tip(fmt::format("{}\nIt reflects {} of daylight at normal incidence, as the eye weighs the wavelengths. The patch is "
                  "the colour of its reflection of white light.",
                  name, share)
          .c_str());
  bring_into_sight(ui, number, ui.state.coating_in_sight);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  list.AddRectFilled({at.x + scaled(26), at.y + scaled(1)}, {at.x + scaled(44), at.y + line - scaled(1)},
                     display_colour(colour, brightest), scaled(3));
  list.AddText(at, colours::text(), fmt::format("{}", number).c_str());
  list.AddText({at.x + scaled(54), at.y}, colours::text(), share.c_str());
  list.AddText({at.x + scaled(kNameAt), at.y}, colours::dim(), shown.c_str());
}

void draw_list(Ui& ui) {
  ImGui::TextDisabled("Surface");
  ImGui::SameLine(scaled(54));
  ImGui::TextDisabled("reflects");
  tip("Of daylight at normal incidence, each wavelength weighted by the eye's sensitivity");
  ImGui::SameLine(scaled(kNameAt));
  ImGui::TextDisabled("with the coating");
  ImGui::BeginChild("##rows");
  const int in_sight_before = ui.state.coating_in_sight;
  const auto& surfaces = ui.studio.lens().surfaces;
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    if (reflects(surfaces[k])) draw_list_row(ui, static_cast<int>(k) + 1, surfaces[k]);
  // The headings above would cut a row in half.
  const float row = ImGui::GetTextLineHeightWithSpacing(), at = ImGui::GetScrollY();
  const bool scrolls_to_row = ui.state.coating_in_sight != in_sight_before;
  if (at < ImGui::GetScrollMaxY() && !scrolls_to_row) ImGui::SetScrollY(row * std::round(at / row));
  ImGui::EndChild();
}

// So wide that the longest name fits, if the plot then still has half of the panel.
float list_width(const Ui& ui) {
  float longest = text_width("with the coating");
  for (const SurfaceState& s : ui.studio.lens().surfaces)
    if (reflects(s)) longest = std::max(longest, text_width(name_of(s.coating)));
  return std::min(longest + scaled(kNameAt + 8) + ImGui::GetStyle().ScrollbarSize,
                  0.5F * ImGui::GetContentRegionAvail().x);
}

void draw_axes(ImDrawList& list, ImVec2 min, ImVec2 max, double top) {
  for (int percent = 0; percent <= 4; ++percent) {
    const float y = max.y - (max.y - min.y) * static_cast<float>(percent) / 4;
    list.AddLine({min.x, y}, {max.x, y}, IM_COL32(255, 255, 255, percent == 0 ? 60 : 20));
    const std::string text = fmt::format("{:.3g} %", 100 * top * percent / 4);
    const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
    list.AddText(small_font(), small_font()->FontSize, {min.x - size.x - scaled(6), y - 0.5F * size.y}, colours::dim(),
                 text.c_str());
  }
  const int step = max.x - min.x < 7.5F * text_width("400  nm") ? 100 : 50;
  for (int lambda = 400; lambda <= 700; lambda += step) {
    const float x =
        min.x + (max.x - min.x) * static_cast<float>((lambda - kFirstCurve_nm) / (kLastCurve_nm - kFirstCurve_nm));
    list.AddLine({x, min.y}, {x, max.y}, IM_COL32(255, 255, 255, 16));
    const std::string text = fmt::format("{}{}", lambda, lambda == 700 ? " nm" : "");
    const ImVec2 size = small_font()->CalcTextSizeA(small_font()->FontSize, 1e9F, 0, text.c_str());
    list.AddText(small_font(), small_font()->FontSize, {x - 0.5F * size.x, max.y + scaled(3)}, colours::dim(),
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

// Above the plot, so that no curve crosses it. right: its upper right corner.
void draw_legend_of_angles(ImDrawList& list, ImVec2 right) {
  float x = right.x;
  for (std::size_t a = kCurveAngles_deg.size(); a-- > 0;) {
    const std::string text = fmt::format("{:.0f}\u00b0{}", kCurveAngles_deg[a], a == 0 ? " incidence" : "");
    x -= text_width(text);
    list.AddText({x, right.y}, kAngleColours[a], text.c_str());
    x -= scaled(18);
  }
}

void draw_plot(Ui& ui, const SurfaceState& surface) {
  const ImVec2 start = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const ImVec2 min = {start.x + scaled(52), start.y + ImGui::GetTextLineHeight() + scaled(4)};
  const ImVec2 max = {start.x + room.x - scaled(14), start.y + room.y - scaled(24)};
  ImGui::Dummy(room);
  ui.registry.record("coatings/plot");
  if (max.x - min.x < 20 || max.y - min.y < 20) return;
  ui.registry.record("coatings/axes", min, max);
  const ReflectanceCurves curves = reflectance_curves(surface);
  const double top = rounded_up(curves.largest);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_axes(list, min, max, top);
  draw_curves(list, curves, min, max, top);
  draw_legend_of_angles(list, {max.x, start.y});
}

bool set_coating(Ui& ui, int surface, const std::string& coating, const std::string& key) {
  return ui.studio.edit(fmt::format("coat surface {}", surface), key,
                        [&](const Document& d) { return with_surface_coating(d, surface, coating); });
}

std::string design_of(const std::string& coating) { return coating.substr(0, coating.find(':')); }

// The kind of coating; its wavelength and its other numbers have fields of their own.
void draw_design_choice(Ui& ui, int number, const std::string& current, float width) {
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##design", fitted(current, width - 2.2F * ImGui::GetFrameHeight()).c_str())) {
    if (const std::string own = own_coating(ui.studio.document(), number); is_only_a_name(own)) {
      if (ImGui::Selectable(fmt::format("{} (the lens's own)", own).c_str(), current == own))
        set_coating(ui, number, own, "");
      ui.registry.record("coatings/design/own", own);
    }
    for (const char* design : kDesigns) {
      if (ImGui::Selectable(design, current == design)) set_coating(ui, number, design, "");
      ui.registry.record(fmt::format("coatings/design/{}", design));
    }
    ImGui::EndCombo();
  }
  ui.registry.record("coatings/design", current);
  tip("The kind of coating");
}

void draw_coating_controls(Ui& ui, const SurfaceState& surface) {
  const int number = ui.studio.selection.surface;
  ImGui::AlignTextToFramePadding();
  ImGui::Text("Surface %d", number);
  ui.registry.record("coatings/label");
  ImGui::SameLine();
  const float gap = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x - 2 * gap;
  const bool is_narrow = room < scaled(380);  // the fields then have two lines
  std::string typed = coating_of_surface(ui.studio.document(), number);
  const auto wavelength = design_wavelength_nm(ui.studio.document(), number);
  draw_design_choice(ui, number, design_of(typed.empty() ? name_of(surface.coating) : typed),
                     is_narrow ? ImGui::GetContentRegionAvail().x : std::min(scaled(190), 0.36F * room));
  if (!is_narrow) ImGui::SameLine();
  const float half = 0.5F * (ImGui::GetContentRegionAvail().x - gap);
  if (text_field(ui, "coatings/text", typed, is_narrow ? half : std::min(scaled(190), 0.34F * room), "v-coat:550") &&
      !typed.empty())
    if (!set_coating(ui, number, typed, "")) refuse_text(ui, "coatings/text", typed, ui.studio.problem());
  tip("The coating as the command line takes it: v-coat:550, quarter-wave:550:1.38, stack:1.38@99.6,ZrO2@0.5w, "
      "measured:FILE");
  if (!wavelength) return;
  ImGui::SameLine();
  auto lambda = static_cast<float>(*wavelength);
  ImGui::SetNextItemWidth(is_narrow ? half : std::min(scaled(170), 0.3F * room));
  if (drag_bar("##lambda", lambda, 380, 760, "%.0f nm"))
    set_coating(ui, number,
                with_design_wavelength(coating_of_surface(ui.studio.document(), number), static_cast<double>(lambda)),
                "coatings/lambda");
  if (ImGui::IsItemDeactivated()) ui.studio.end_gesture();
  ui.registry.record("coatings/lambda", fmt::format("{:.1f}", lambda));
  tip("The wavelength that the coating is made for. Drag, or click to type.");
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
  ImGui::BeginChild("##surfaces", {list_width(ui), 0});
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
