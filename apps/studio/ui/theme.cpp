// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/theme.h"

#include <array>
#include <cmath>
#include <filesystem>

namespace contrejour::studio {
namespace {

constexpr float kFontSize = 15.0F, kSmallSize = 13.0F;

// Debian's folders; the font that comes with Dear ImGui stands in where none is installed.
constexpr std::array kRegular = {"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                                 "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
constexpr std::array kMedium = {"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf",
                                "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};

// Latin, Greek, dashes and quotes, arrows, mathematical signs.
constexpr std::array<ImWchar, 11> kGlyphs = {0x20,   0x17F,  0x370,  0x3FF,  0x2010, 0x2044,
                                             0x2190, 0x2193, 0x2200, 0x226F, 0};

ImFont* load_font(const std::array<const char*, 2>& files, float size) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  std::error_code code;
  for (const char* file : files)
    if (std::filesystem::exists(file, code)) return atlas.AddFontFromFileTTF(file, size, nullptr, kGlyphs.data());
  ImFontConfig config;
  config.SizePixels = size;
  return atlas.AddFontDefault(&config);
}

ImVec4 rgb(int r, int g, int b, float a = 1.0F) {
  return {static_cast<float>(r) / 255, static_cast<float>(g) / 255, static_cast<float>(b) / 255, a};
}

// High contrast draws the border of every field, button and dialog, since all lie on black.
void set_distances(ImGuiStyle& style, bool high_contrast) {
  style.WindowPadding = {10, 8};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.CellPadding = {6, 3};
  style.IndentSpacing = 16;
  style.ScrollbarSize = 11;
  style.GrabMinSize = 10;
  style.WindowRounding = 0;
  style.ChildRounding = 0;
  style.PopupRounding = 6;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.ScrollbarRounding = 6;
  style.TabRounding = 4;
  style.WindowBorderSize = 0;
  style.ChildBorderSize = high_contrast ? 1 : 0;
  style.FrameBorderSize = high_contrast ? 1 : 0;
  style.PopupBorderSize = 1;
  style.WindowTitleAlign = {0.02F, 0.5F};
}

void set_colours(ImGuiStyle& style, bool high_contrast) {
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = high_contrast ? rgb(255, 255, 255) : rgb(222, 226, 232);
  c[ImGuiCol_TextDisabled] = high_contrast ? rgb(214, 218, 224) : rgb(146, 154, 166);
  c[ImGuiCol_WindowBg] = high_contrast ? rgb(0, 0, 0) : rgb(21, 23, 27);
  c[ImGuiCol_ChildBg] = high_contrast ? rgb(0, 0, 0) : rgb(27, 30, 35);
  c[ImGuiCol_PopupBg] = high_contrast ? rgb(0, 0, 0) : rgb(32, 36, 42);
  c[ImGuiCol_Border] = high_contrast ? rgb(180, 180, 180) : rgb(62, 68, 78);
  c[ImGuiCol_FrameBg] = high_contrast ? rgb(40, 40, 40) : rgb(40, 45, 53);
  c[ImGuiCol_FrameBgHovered] = rgb(52, 58, 68);
  c[ImGuiCol_FrameBgActive] = rgb(62, 69, 81);
  c[ImGuiCol_Button] = rgb(46, 52, 61);
  c[ImGuiCol_ButtonHovered] = rgb(64, 72, 85);
  c[ImGuiCol_ButtonActive] = rgb(80, 90, 106);
  c[ImGuiCol_Header] = rgb(46, 58, 74);
  c[ImGuiCol_HeaderHovered] = rgb(56, 70, 90);
  c[ImGuiCol_HeaderActive] = rgb(66, 82, 105);
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = high_contrast ? rgb(0, 0, 0) : rgb(38, 43, 50);
  c[ImGuiCol_Separator] = high_contrast ? rgb(180, 180, 180) : rgb(50, 56, 65);
  c[ImGuiCol_CheckMark] = rgb(240, 173, 78);
  // The value is written over the knob: these are dark enough for its text.
  c[ImGuiCol_SliderGrab] = rgb(132, 95, 43);
  c[ImGuiCol_SliderGrabActive] = rgb(160, 115, 52);
  c[ImGuiCol_Tab] = rgb(27, 30, 35);
  c[ImGuiCol_TabHovered] = rgb(64, 72, 85);
  c[ImGuiCol_TabActive] = rgb(46, 52, 61);
  c[ImGuiCol_TabUnfocused] = c[ImGuiCol_Tab];
  c[ImGuiCol_TabUnfocusedActive] = c[ImGuiCol_TabActive];
  c[ImGuiCol_TableHeaderBg] = rgb(33, 37, 43);
  c[ImGuiCol_TableBorderLight] = high_contrast ? rgb(80, 80, 80) : rgb(38, 43, 50);
  c[ImGuiCol_TableBorderStrong] = rgb(50, 56, 65);
  c[ImGuiCol_TableRowBg] = rgb(0, 0, 0, 0);
  c[ImGuiCol_TableRowBgAlt] = rgb(255, 255, 255, 0.018F);
  c[ImGuiCol_ScrollbarBg] = rgb(0, 0, 0, 0);
  c[ImGuiCol_ScrollbarGrab] = rgb(70, 77, 89);
  c[ImGuiCol_TextSelectedBg] = rgb(240, 173, 78, 0.35F);
  c[ImGuiCol_NavHighlight] = rgb(102, 178, 255);
  c[ImGuiCol_ModalWindowDimBg] = rgb(0, 0, 0, 0.55F);
  c[ImGuiCol_PlotLines] = rgb(240, 173, 78);
}

}  // namespace

ImU32 colours::text() { return ImGui::GetColorU32(ImGuiCol_Text); }
ImU32 colours::dim() { return ImGui::GetColorU32(ImGuiCol_TextDisabled); }
ImU32 colours::line() { return ImGui::GetColorU32(ImGuiCol_Border); }

void set_theme(float scale, bool high_contrast) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  set_distances(style, high_contrast);
  set_colours(style, high_contrast);
  style.ScaleAllSizes(scale);
  ImGui::GetIO().Fonts->Clear();
  load_font(kRegular, std::round(kFontSize * scale));
  load_font(kMedium, std::round(kFontSize * scale));
  load_font(kRegular, std::round(kSmallSize * scale));
}

ImFont* medium_font() { return ImGui::GetIO().Fonts->Fonts[1]; }
ImFont* small_font() { return ImGui::GetIO().Fonts->Fonts[2]; }

float scaled(float distance) { return std::round(distance * ImGui::GetIO().Fonts->Fonts[0]->FontSize / kFontSize); }

}  // namespace contrejour::studio
