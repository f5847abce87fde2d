// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/texture.h"

#include <cmath>

#include <GLFW/glfw3.h>

#include "studio/ui/theme.h"

#ifndef GL_CLAMP_TO_EDGE
#define GL_CLAMP_TO_EDGE 0x812F
#endif

namespace contrejour::studio {

Texture::~Texture() {
  if (name_ != 0) glDeleteTextures(1, &name_);
}

void Texture::set(int width, int height, std::span<const std::uint32_t> rgba) {
  const bool is_new = name_ == 0;
  if (is_new) glGenTextures(1, &name_);
  glBindTexture(GL_TEXTURE_2D, name_);
  if (is_new) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  if (width != width_ || height != height_)
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  else
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  width_ = width;
  height_ = height;
  ++changes_;
}

void Texture::set_smooth(bool smooth) {
  if (name_ == 0 || smooth == is_smooth_) return;
  is_smooth_ = smooth;
  ++changes_;
  glBindTexture(GL_TEXTURE_2D, name_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, smooth ? GL_LINEAR : GL_NEAREST);
}

Texture& TextureSet::get(const std::string& name, std::uint64_t stamp, int width, int height,
                         std::span<const std::uint32_t> rgba) {
  Entry& entry = entries_[name];
  if (entry.texture.is_empty() || entry.stamp != stamp) entry.texture.set(width, height, rgba);
  entry.stamp = stamp;
  return entry.texture;
}

void Texture::clear_canvas(const ImDrawList* /*list*/, const ImDrawCmd* command) {
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  const ImVec4 clip = command->ClipRect;
  const auto pixel = [](float v) { return static_cast<GLint>(std::lround(v)); };
  const GLint height = pixel(ImGui::GetIO().DisplaySize.y * scale.y);
  glEnable(GL_SCISSOR_TEST);
  glScissor(pixel(clip.x * scale.x), height - pixel(clip.w * scale.y), pixel((clip.z - clip.x) * scale.x),
            pixel((clip.w - clip.y) * scale.y));
  const ImVec4 canvas = ImGui::ColorConvertU32ToFloat4(colours::kCanvas);
  glClearColor(canvas.x, canvas.y, canvas.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_BLEND);
}

}  // namespace contrejour::studio
