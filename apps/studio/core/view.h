// SPDX-License-Identifier: Apache-2.0
// How a document is looked at: the parts that are saved with a session, apart from its content.
// Thread-safety: plain values, pure functions.
#pragma once

#include <string>

#include "contrejour/expert/vec.h"
#include "studio/core/view_codes.h"

namespace contrejour::studio {

inline constexpr const char* kViewKey = "studio-view";  // of the session's member

struct View {
  double zoom = 1.0;  // of the picture that just fits
  Vec2 pan;  // of its middle, in parts of the fitting picture's size
  ViewTransform transform = ViewTransform::Preview;
  ColourViewName colour;  // of ViewTransform::Colour
  double interface_scale = 0;  // 0: that of the program's start
  bool shows_handles = true;
  bool shows_ghosts = true;  // outline of the selected ghost
  int frame = 1, first_frame = 1, last_frame = 48;  // of the timeline
  double frames_per_second = 24.0;
};

[[nodiscard]] std::string json_of_view(const View& view);
// Members that are missing, or have no valid value, take their defaults.
[[nodiscard]] View view_of_json(const std::string& text);

}  // namespace contrejour::studio
