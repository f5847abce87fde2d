// SPDX-License-Identifier: Apache-2.0
// The place of the picture on the screen. Thread-safety: a plain value.
#pragma once

#include <imgui.h>

#include "contrejour/expert/vec.h"

namespace contrejour::studio {

struct ViewportMap {
  ImVec2 canvas_min, canvas_max;  // of the whole viewport
  ImVec2 picture_min;  // of the picture's top left corner
  float scale = 1;  // of the screen per pixel of the picture
  int width = 1, height = 1;  // of the picture in pixels

  [[nodiscard]] ImVec2 screen_of_pixel(Vec2 p) const {
    return {picture_min.x + static_cast<float>(p.x) * scale, picture_min.y + static_cast<float>(p.y) * scale};
  }
  [[nodiscard]] Vec2 pixel_of_screen(ImVec2 s) const {
    return {static_cast<double>((s.x - picture_min.x) / scale), static_cast<double>((s.y - picture_min.y) / scale)};
  }
  [[nodiscard]] ImVec2 screen_of_uv(Vec2 uv) const { return screen_of_pixel({uv.x * width, uv.y * height}); }
  [[nodiscard]] Vec2 uv_of_screen(ImVec2 s) const {
    const Vec2 p = pixel_of_screen(s);
    return {p.x / width, p.y / height};
  }
  [[nodiscard]] bool is_in_picture(ImVec2 s) const {
    const Vec2 p = pixel_of_screen(s);
    return p.x >= 0 && p.y >= 0 && p.x < width && p.y < height;
  }
};

}  // namespace contrejour::studio
