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

// Breaks a text at spaces into lines of at most this width: Dear ImGui also breaks behind the point of a number.
std::string wrapped(const std::string& text, float width) {
  std::string lines;
  std::size_t line = 0, at = 0;  // where the last line begins in `lines`; how much of the text is there
  while (at < text.size()) {
    const std::size_t end = std::min(text.find_first_of(" \n", at + 1), text.size());
    const std::string word = text.substr(at, end - at);
    const bool is_new = word.front() == '\n';
    if (is_new || (lines.size() > line && text_width(lines.substr(line) + word) > width)) {
      lines += '\n';
      line = lines.size();
      lines += word.front() == ' ' || is_new ? word.substr(1) : word;
    } else {
      lines += word;
    }
    at = end;
  }
  return lines;
}

// While an item is dragged or typed in, and just after a click, the user looks at the item, and its tip would hide it.
bool is_in_use(ImVec2 min, ImVec2 max) {
  constexpr double kAfterClick_s = 1.5;
  const ImGuiIO& io = ImGui::GetIO();
  const bool was_clicked =
      ImRect(min, max).Contains(io.MouseClickedPos[0]) && ImGui::GetTime() - io.MouseClickedTime[0] < kAfterClick_s;
  return was_clicked || ImGui::IsItemActive() || ImGui::IsMouseDown(ImGuiMouseButton_Left);
}

// Places a tip below its item, or above it where it would not fit; beside the mouse if the item is large.
ImVec2 place_of_tip(ImVec2 min, ImVec2 max, ImVec2 size) {
  const ImVec2 window = ImGui::GetIO().DisplaySize, mouse = ImGui::GetIO().MousePos;
  const float gap = scaled(4), x = std::clamp(mouse.x, gap, std::max(gap, window.x - size.x - gap));
  if (max.y - min.y > 3 * ImGui::GetFrameHeight()) {
    min = {mouse.x, mouse.y - scaled(8)};
    max = {mouse.x, mouse.y + scaled(20)};
  }
  return {x, max.y + gap + size.y < window.y ? max.y + gap : std::max(0.0F, min.y - gap - size.y)};
}

void tip(const char* text) {
  if (text == nullptr || *text == '\0' || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  if (is_in_use(min, max)) return;
  const std::string shown = wrapped(text, scaled(420));
  const ImVec2 padding = ImGui::GetStyle().WindowPadding, text_size = ImGui::CalcTextSize(shown.c_str());
  ImGui::SetNextWindowPos(place_of_tip(min, max, {text_size.x + 2 * padding.x, text_size.y + 2 * padding.y}));
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(shown.c_str());
  ImGui::EndTooltip();
}

bool drag_bar(const char* label, float& value, float low, float high, const char* format, ImGuiSliderFlags flags) {
  constexpr float kPerPixel = 0.002F;  // of the range
  const bool changed = ImGui::DragFloat(label, &value, kPerPixel * (high - low) / scaled(1), low, high, format,
                                        flags | ImGuiSliderFlags_AlwaysClamp);
  const float part = (flags & ImGuiSliderFlags_Logarithmic) != 0 ? std::log(value / low) / std::log(high / low)
                                                                 : (value - low) / (high - low);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  const float right = min.x + std::clamp(part, 0.0F, 1.0F) * (max.x - min.x);
  if (right > min.x + 1)
    ImGui::GetWindowDrawList()->AddRectFilled({min.x, max.y - scaled(3)}, {right, max.y}, colours::kAccent, scaled(2));
  return changed;
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

void heading_row(std::initializer_list<const char*> tips, int first_field, int fields, float indent) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  int column = 0;
  for (const char* text : tips) {
    if (ImGui::TableSetColumnIndex(column)) {
      ImGui::PushID(column);
      if (column >= first_field && column < first_field + fields) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + indent);
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
  if (edit.refused_id == id && (edit.refused_over != text || ui.studio.history().position() < edit.refused_at))
    edit.refused_id.clear();
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
  edit.entered_over = text;
  if (accepts) text = edit.id == id ? edit.text : shown;
  if (edit.id == id) edit.id.clear();
  if (is_refused) edit.refused_id.clear();
  return accepts;
}

void refuse_text(Ui& ui, const std::string& id, const std::string& text, const std::string& reason) {
  ui.state.edit.refused_id = id;
  ui.state.edit.refused_text = text;
  ui.state.edit.reason = reason;
  ui.state.edit.refused_over = ui.state.edit.entered_over;
  ui.state.edit.refused_at = ui.studio.history().position();
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

bool is_wholly_in_sight() {
  const ImVec2 low = ImGui::GetWindowDrawList()->GetClipRectMin(), high = ImGui::GetWindowDrawList()->GetClipRectMax();
  return ImGui::GetItemRectMin().y >= low.y && ImGui::GetItemRectMax().y <= high.y;
}

void bring_into_sight(const Ui& ui, int surface, int& in_sight) {
  if (ui.studio.selection.surface != surface || in_sight == surface) return;
  if (!is_wholly_in_sight()) ImGui::SetScrollHereY(0.5F);
  in_sight = surface;
}

ImU32 display_colour(const Rgb& rgb, double brightest) {
  const auto code = [&](double v) {
    return static_cast<int>(std::lround(255 * std::pow(std::clamp(v / brightest, 0.0, 1.0), 1 / 2.2)));
  };
  return IM_COL32(code(rgb[0]), code(rgb[1]), code(rgb[2]), 255);
}

}  // namespace contrejour::studio
