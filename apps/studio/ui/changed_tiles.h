// SPDX-License-Identifier: Apache-2.0
// Without a graphics card, nearly all the time of a frame goes into drawing pixels, most of which are those of the
// frame before. ChangedTiles finds the tiles of the window in which a frame differs from the one before, and reduces
// its draw lists to them. A tile's pixels depend on the triangles that touch it, in their order, with their textures
// and the render state: a tile whose hash of these is as before keeps its pixels. A texture's id must change with its
// pixels. Thread-safety: the thread of the interface.
#pragma once

#include <cstdint>
#include <vector>

#include <imgui.h>

namespace contrejour::studio {

// In pixels of the framebuffer, from its top left corner; the end is outside.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool is_empty() const { return x0 >= x1 || y0 >= y1; }
  [[nodiscard]] int area() const { return is_empty() ? 0 : (x1 - x0) * (y1 - y0); }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

class ChangedTiles {
 public:
  // Rectangles that cover the tiles that differ from the frame before and do not overlap; the whole frame after
  // forget() or for another size of the framebuffer.
  [[nodiscard]] std::vector<PixelRect> find(const ImDrawData& frame);
  // The window's pixels are lost: the next frame is drawn whole.
  void forget() { hashes_.clear(); }

 private:
  std::vector<std::uint64_t> hashes_;
  int width_ = 0, height_ = 0;  // of the framebuffer
};

// Takes from the frame's draw lists what touches none of these rectangles, and clips the rest to them.
void reduce_to(const std::vector<PixelRect>& rects, ImDrawData& frame);

}  // namespace contrejour::studio
