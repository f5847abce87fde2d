// SPDX-License-Identifier: Apache-2.0
// A picture on the graphics card, for Dear ImGui to draw. Needs a current OpenGL context.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include <imgui.h>

namespace contrejour::studio {

class Texture {
 public:
  Texture() = default;
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  void set(int width, int height, std::span<const std::uint32_t> rgba);
  // Between pixels that are magnified: their mean, or none.
  void set_smooth(bool smooth);
  // As a callback of a draw list: its clip rectangle becomes the canvas, by far sooner than a rectangle that is drawn
  // would, and what follows is not blended with what is there.
  static void clear_canvas(const ImDrawList* list, const ImDrawCmd* command);
  // OpenGL's name in the lower half, which is all that Dear ImGui's renderer takes of it; above it a count of changes,
  // by which ChangedTiles knows that the pixels are others.
  [[nodiscard]] ImTextureID id() const {
    static_assert(sizeof(ImTextureID) == sizeof(std::uint64_t));
    return reinterpret_cast<ImTextureID>(static_cast<std::uint64_t>(changes_) << 32U | name_);
  }
  [[nodiscard]] bool is_empty() const { return name_ == 0; }

 private:
  std::uint32_t name_ = 0, changes_ = 0;
  bool is_smooth_ = true;
  int width_ = 0, height_ = 0;
};

// Textures by name, each set anew where its pixels have changed.
class TextureSet {
 public:
  // stamp: a number that changes with the pixels.
  Texture& get(const std::string& name, std::uint64_t stamp, int width, int height,
               std::span<const std::uint32_t> rgba);

 private:
  struct Entry {
    Texture texture;
    std::uint64_t stamp = 0;
  };
  std::map<std::string, Entry> entries_;
};

}  // namespace contrejour::studio
