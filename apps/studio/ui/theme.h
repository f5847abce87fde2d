// SPDX-License-Identifier: Apache-2.0
// Colours, distances and fonts of the interface, in one place.
#pragma once

#include <imgui.h>

namespace contrejour::studio {

namespace colours {
inline constexpr ImU32 kAccent = IM_COL32(240, 173, 78, 255);
inline constexpr ImU32 kAccentDim = IM_COL32(240, 173, 78, 110);
inline constexpr ImU32 kGood = IM_COL32(122, 199, 140, 255);
inline constexpr ImU32 kBad = IM_COL32(235, 98, 88, 255);
inline constexpr ImU32 kBadBack = IM_COL32(120, 36, 34, 255);
inline constexpr ImU32 kText = IM_COL32(222, 226, 232, 255);  // on the picture
inline constexpr ImU32 kLine = IM_COL32(62, 68, 78, 255);  // on the picture
inline constexpr ImU32 kCanvas = IM_COL32(9, 10, 12, 255);
inline constexpr ImU32 kShade = IM_COL32(12, 13, 16, 190);
inline constexpr ImU32 kSelected = IM_COL32(102, 178, 255, 255);
inline constexpr ImU32 kSelectedDim = IM_COL32(102, 178, 255, 110);
// The colours of the theme in force, which high contrast changes; paler between BeginDisabled and EndDisabled.
[[nodiscard]] ImU32 text();
[[nodiscard]] ImU32 dim();
[[nodiscard]] ImU32 line();
}  // namespace colours

// Sets the style and loads the fonts; before the first frame. scale: 0.75 to 3.
void set_theme(float scale, bool high_contrast);

// Regular is the default of every frame.
[[nodiscard]] ImFont* medium_font();
[[nodiscard]] ImFont* small_font();

// A distance at scale 1, on the screen.
[[nodiscard]] float scaled(float distance);

}  // namespace contrejour::studio
