// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/widgets.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "studio/ui/theme.h"

namespace contrejour::studio {

void WidgetRegistry::record(std::string id, std::string value) {
  record(std::move(id), ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), std::move(value));
}

void WidgetRegistry::record(std::string id, ImVec2 min, ImVec2 max, std::string value) {
  const ImRect panel = ImGui::GetCurrentWindow()->OuterRectClipped;
  const bool clipped =
      min.x < panel.Min.x - 1 || max.x > panel.Max.x + 1 || min.y < panel.Min.y - 1 || max.y > panel.Max.y + 1;
  const bool hidden = !panel.Contains(ImVec2(0.5F * (min.x + max.x), 0.5F * (min.y + max.y)));
  widgets_.push_back({std::move(id), min, max, std::move(value), clipped, hidden});
}

const WidgetRecord* WidgetRegistry::find(const std::string& id) const {
  const auto found = std::find_if(widgets_.begin(), widgets_.end(), [&](const WidgetRecord& w) { return w.id == id; });
  return found != widgets_.end() ? &*found : nullptr;
}

void tip(const char* text) {
  if (text == nullptr || *text == '\0' || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(scaled(420));
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool button(Ui& ui, const std::string& id, const char* label, const char* text, ImVec2 size) {
  ImGui::PushID(id.c_str());
  const bool pressed = ImGui::Button(label, size);
  ImGui::PopID();
  ui.registry.record(id);
  tip(text);
  return pressed;
}

bool toggle(Ui& ui, const std::string& id, const char* label, bool on, ImU32 lit, const char* text) {
  ImGui::PushID(id.c_str());
  if (on) {
    ImGui::PushStyleColor(ImGuiCol_Button, lit);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, lit);
    ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(20, 20, 22, 255));
  }
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, 0));
  const bool pressed = ImGui::Button(label, {scaled(20), ImGui::GetTextLineHeight() + scaled(2)});
  ImGui::PopStyleVar();
  if (on) ImGui::PopStyleColor(3);
  ImGui::PopID();
  ui.registry.record(id, on ? "on" : "off");
  tip(text);
  return pressed;
}

void align_right(std::initializer_list<const char*> labels, float others) {
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = others;
  for (const char* label : labels)
    width += ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x + style.ItemSpacing.x;
  ImGui::SameLine(std::max(ImGui::GetCursorPosX(), ImGui::GetContentRegionMax().x - width + style.ItemSpacing.x));
}

void colour_patch(ImU32 colour, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + scaled(2)}, {at.x + width, at.y + height - scaled(1)}, colour,
                                            scaled(3));
  ImGui::Dummy({width, height});
}

std::string fitted(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string shown = text;
  while (!shown.empty()) {
    bool is_rest_of_letter = true;  // of several bytes in UTF-8
    while (is_rest_of_letter && !shown.empty()) {
      is_rest_of_letter = (static_cast<unsigned char>(shown.back()) & 0xC0U) == 0x80U;
      shown.pop_back();
    }
    if (ImGui::CalcTextSize((shown + "\u2026").c_str()).x <= width) break;
  }
  return shown + "\u2026";
}

void fitting_text(const std::string& text, float width, ImU32 colour) {
  const std::string shown = fitted(text, width);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(shown.c_str());
  ImGui::PopStyleColor();
  if (shown != text) tip(text.c_str());
}

float text_width(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }

bool contains_in_any_case(std::string_view text, std::string_view part) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::search(text.begin(), text.end(), part.begin(), part.end(),
                     [&](char a, char b) { return lower(a) == lower(b); }) != text.end();
}

void heading_row(std::initializer_list<const char*> tips) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  int column = 0;
  for (const char* text : tips) {
    if (ImGui::TableSetColumnIndex(column)) {
      ImGui::PushID(column);
      ImGui::TableHeader(ImGui::TableGetColumnName(column));
      ImGui::PopID();
      tip(text);
    }
    ++column;
  }
}

// Says that the field drawn last has more text than fits, unless it is being edited.
void mark_cut_text(Ui& ui, const std::string& text) {
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  if (ImGui::IsItemActive() || text_width(text) <= max.x - min.x - 2 * padding.x) return;
  ui.registry.mark_cut();
  const float left = max.x - padding.x - text_width("\u2026") - 1;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({left, min.y + 1}, {max.x, max.y - 1}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                     ImGui::GetStyle().FrameRounding, ImDrawFlags_RoundCornersRight);
  list.AddText({left + 1, min.y + padding.y}, colours::text(), "\u2026");
  tip(text.c_str());
}

using Completion = std::string (*)(const std::string& text);

int complete_text(ImGuiInputTextCallbackData* data) {
  const Completion complete = *static_cast<Completion*>(data->UserData);
  const std::string text = complete(std::string(data->Buf, static_cast<std::size_t>(data->BufTextLen)));
  data->DeleteChars(0, data->BufTextLen);
  data->InsertChars(0, text.c_str());
  return 0;
}

bool text_field(Ui& ui, const std::string& id, std::string& text, float width, const char* hint, Completion complete) {
  TextEdit& edit = ui.state.edit;
  const bool is_edited = edit.id == id, is_refused = edit.refused_id == id;
  std::string& shown = is_edited ? edit.text : is_refused ? edit.refused_text : text;
  if (is_refused) ImGui::PushStyleColor(ImGuiCol_FrameBg, colours::kBadBack);
  ImGui::PushID(id.c_str());
  ImGui::SetNextItemWidth(width);
  const ImGuiInputTextFlags flags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll |
                                    (complete != nullptr ? ImGuiInputTextFlags_CallbackCompletion : 0);
  const bool entered = ImGui::InputTextWithHint("##field", hint, &shown, flags,
                                                complete != nullptr ? complete_text : nullptr, &complete);
  const bool started = ImGui::IsItemActivated(), left = ImGui::IsItemDeactivated();
  const bool was_changed = ImGui::IsItemDeactivatedAfterEdit();
  ImGui::PopID();
  ui.registry.record(id, shown);
  mark_cut_text(ui, shown);
  if (is_refused) ImGui::PopStyleColor();
  if (is_refused) tip(edit.reason.c_str());
  if (started && !is_edited) {
    edit.id = id;
    edit.text = shown;
  }
  if (!left && !entered) return false;
  const bool accepts = entered || was_changed;
  if (accepts) text = edit.id == id ? edit.text : shown;
  if (edit.id == id) edit.id.clear();
  if (is_refused) edit.refused_id.clear();
  return accepts;
}

void refuse_text(Ui& ui, const std::string& id, const std::string& text, const std::string& reason) {
  ui.state.edit.refused_id = id;
  ui.state.edit.refused_text = text;
  ui.state.edit.reason = reason;
}

void begin_completions(std::size_t lines) {
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax(), padding = ImGui::GetStyle().WindowPadding;
  const float height = static_cast<float>(lines) * ImGui::GetTextLineHeightWithSpacing() + 2 * padding.y;
  const bool fits = max.y + height < ImGui::GetIO().DisplaySize.y;
  ImGui::SetNextWindowPos({min.x, fits ? max.y + scaled(2) : min.y - height - scaled(2)});
  ImGui::SetNextWindowSize({std::max(max.x - min.x, scaled(180)), height});
  ImGui::Begin("##completions", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
}

bool completion(const std::string& text) {
  const ImVec2 min = ImGui::GetCursorScreenPos();
  const ImVec2 max{min.x + ImGui::GetContentRegionAvail().x, min.y + ImGui::GetTextLineHeight()};
  // Dear ImGui reports no item as hovered while a text field is active.
  const bool is_under_mouse = ImGui::IsMouseHoveringRect(min, max);
  ImGui::Selectable(text.c_str(), is_under_mouse);
  return is_under_mouse;
}

void bring_into_sight(const Ui& ui, int surface, int& in_sight) {
  if (ui.studio.selection.surface != surface || in_sight == surface) return;
  ImGui::SetScrollHereY(0.5F);
  in_sight = surface;
}

ImU32 display_colour(const Rgb& rgb, double brightest) {
  const auto code = [&](double v) {
    return static_cast<int>(std::lround(255 * std::pow(std::clamp(v / brightest, 0.0, 1.0), 1 / 2.2)));
  };
  return IM_COL32(code(rgb[0]), code(rgb[1]), code(rgb[2]), 255);
}

}  // namespace contrejour::studio
