// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/changed_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace contrejour::studio {
namespace {

// Smaller tiles leave out more, but take longer to find: a glyph is about 8 by 15 pixels.
constexpr int kTile = 32;

struct FrameSize {
  int width = 0, height = 0;  // of the framebuffer
  ImVec2 scale = {1, 1};  // its pixels for each unit of the draw lists
  ImVec2 origin = {0, 0};
};

FrameSize size_of(const ImDrawData& frame) {
  const ImVec2 scale = frame.FramebufferScale;
  return {static_cast<int>(frame.DisplaySize.x * scale.x), static_cast<int>(frame.DisplaySize.y * scale.y), scale,
          frame.DisplayPos};
}

PixelRect common(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// The pixels that Dear ImGui's OpenGL renderer lets a command draw: it rounds the corner and the extent down, and
// counts rows from the bottom.
PixelRect clip_of(const ImDrawCmd& command, const FrameSize& size) {
  const ImVec4& c = command.ClipRect;
  const float x0 = (c.x - size.origin.x) * size.scale.x, y0 = (c.y - size.origin.y) * size.scale.y;
  const float x1 = (c.z - size.origin.x) * size.scale.x, y1 = (c.w - size.origin.y) * size.scale.y;
  const int left = static_cast<int>(x0), bottom = static_cast<int>(static_cast<float>(size.height) - y1);
  const PixelRect drawn = {left, size.height - bottom - static_cast<int>(y1 - y0), left + static_cast<int>(x1 - x0),
                           size.height - bottom};
  return common(drawn, {0, 0, size.width, size.height});
}

ImVec4 clip_of(const PixelRect& rect, const FrameSize& size) {
  return {size.origin.x + static_cast<float>(rect.x0) / size.scale.x,
          size.origin.y + static_cast<float>(rect.y0) / size.scale.y,
          size.origin.x + static_cast<float>(rect.x1) / size.scale.x,
          size.origin.y + static_cast<float>(rect.y1) / size.scale.y};
}

using Triangle = std::array<const ImDrawVert*, 3>;

Triangle triangle_of(const ImDrawList& list, const ImDrawCmd& command, unsigned first) {
  Triangle corners{};
  for (unsigned k = 0; k < 3; ++k) {
    const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + first + k)];
    corners[k] = &list.VtxBuffer[static_cast<int>(command.VtxOffset + index)];
  }
  return corners;
}

// The pixels that a triangle may touch.
PixelRect box_of(const Triangle& corners, const FrameSize& size) {
  ImVec2 min = corners[0]->pos, max = min;
  for (const ImDrawVert* v : {corners[1], corners[2]}) {
    min = {std::min(min.x, v->pos.x), std::min(min.y, v->pos.y)};
    max = {std::max(max.x, v->pos.x), std::max(max.y, v->pos.y)};
  }
  const auto pixel = [](float v, float origin, float scale, int end) {
    return std::clamp((v - origin) * scale, -1.0F, static_cast<float>(end) + 1);
  };
  return {static_cast<int>(std::floor(pixel(min.x, size.origin.x, size.scale.x, size.width))),
          static_cast<int>(std::floor(pixel(min.y, size.origin.y, size.scale.y, size.height))),
          static_cast<int>(std::ceil(pixel(max.x, size.origin.x, size.scale.x, size.width))),
          static_cast<int>(std::ceil(pixel(max.y, size.origin.y, size.scale.y, size.height)))};
}

// Combines two 64-bit values by multiplication and rotation, as FxHash does.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  return (std::rotl(hash, 5) ^ value) * 0x517CC1B727220A95ULL;
}

std::uint64_t hash_of(const Triangle& corners, std::uint64_t state) {
  std::uint64_t hash = state;
  for (const ImDrawVert* v : corners) {
    std::array<std::uint64_t, 2> words{};
    static_assert(sizeof(v->pos) == 8 && sizeof(v->uv) == 8 && sizeof(v->col) == 4);
    std::memcpy(words.data(), &v->pos, 8);
    std::memcpy(&words[1], &v->uv, 8);
    hash = mixed(mixed(mixed(hash, words[0]), words[1]), v->col);
  }
  return hash;
}

// Corners of rectangles become tiles.
class TileHashes {
 public:
  explicit TileHashes(const FrameSize& size)
      : across_((size.width + kTile - 1) / kTile), down_((size.height + kTile - 1) / kTile),
        hashes_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_), 1) {}

  void add(const PixelRect& rect, std::uint64_t hash) {
    if (rect.is_empty()) return;
    for (int y = rect.y0 / kTile; y <= (rect.y1 - 1) / kTile; ++y)
      for (int x = rect.x0 / kTile; x <= (rect.x1 - 1) / kTile; ++x) {
        std::uint64_t& tile = hashes_[static_cast<std::size_t>(y * across_ + x)];
        tile = mixed(tile, hash);
      }
  }

  [[nodiscard]] int across() const { return across_; }
  [[nodiscard]] int down() const { return down_; }
  [[nodiscard]] std::vector<std::uint64_t> take() && { return std::move(hashes_); }

 private:
  int across_, down_;
  std::vector<std::uint64_t> hashes_;
};

std::uint64_t hash_of_clip(const PixelRect& clip) {
  const auto pair = [](int a, int b) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32U | static_cast<std::uint32_t>(b);
  };
  return mixed(mixed(0, pair(clip.x0, clip.y0)), pair(clip.x1, clip.y1));
}

void add_triangles(const ImDrawList& list, const ImDrawCmd& command, std::uint64_t state, const FrameSize& size,
                   TileHashes& tiles) {
  const PixelRect clip = clip_of(command, size);
  if (clip.is_empty()) return;
  // A clip rectangle that moves cuts other pixels off the same triangles.
  const std::uint64_t common_hash =
      mixed(mixed(state, hash_of_clip(clip)), reinterpret_cast<std::uintptr_t>(command.GetTexID()));
  for (unsigned first = 0; first + 2 < command.ElemCount; first += 3) {
    const Triangle corners = triangle_of(list, command, first);
    tiles.add(common(box_of(corners, size), clip), hash_of(corners, common_hash));
  }
}

// Rows of changed tiles, those of equal extent in neighbouring rows as one.
std::vector<PixelRect> rects_of(const std::vector<bool>& changed, int across, int down) {
  std::vector<PixelRect> done, open;
  for (int y = 0; y < down; ++y) {
    std::vector<PixelRect> row;
    for (int x = 0; x < across; ++x) {
      if (!changed[static_cast<std::size_t>(y * across + x)]) continue;
      if (!row.empty() && row.back().x1 == x)
        ++row.back().x1;
      else
        row.push_back({x, y, x + 1, y + 1});
    }
    for (PixelRect& run : row) {
      const auto above =
          std::find_if(open.begin(), open.end(), [&](const PixelRect& r) { return r.x0 == run.x0 && r.x1 == run.x1; });
      if (above == open.end()) continue;
      run.y0 = above->y0;
      open.erase(above);
    }
    done.insert(done.end(), open.begin(), open.end());
    open = std::move(row);
  }
  done.insert(done.end(), open.begin(), open.end());
  return done;
}

// The triangles of a command that touch the rectangle, with indices at the end of `indices`.
void add_part(const ImDrawList& list, const ImDrawCmd& command, const PixelRect& rect, const FrameSize& size,
              ImVector<ImDrawCmd>& commands, ImVector<ImDrawIdx>& indices) {
  ImDrawCmd part = command;
  part.ClipRect = clip_of(rect, size);
  part.IdxOffset = static_cast<unsigned>(indices.Size);
  for (unsigned first = 0; first + 2 < command.ElemCount; first += 3) {
    if (common(box_of(triangle_of(list, command, first), size), rect).is_empty()) continue;
    for (unsigned k = 0; k < 3; ++k) indices.push_back(list.IdxBuffer[static_cast<int>(command.IdxOffset + first + k)]);
  }
  part.ElemCount = static_cast<unsigned>(indices.Size) - part.IdxOffset;
  if (part.ElemCount > 0) commands.push_back(part);
}

}  // namespace

std::vector<PixelRect> ChangedTiles::find(const ImDrawData& frame) {
  const FrameSize size = size_of(frame);
  TileHashes tiles(size);
  for (int n = 0; n < frame.CmdListsCount; ++n) {
    std::uint64_t state = 0;
    for (const ImDrawCmd& command : frame.CmdLists[n]->CmdBuffer) {
      if (command.UserCallback == nullptr) {
        add_triangles(*frame.CmdLists[n], command, state, size, tiles);
        continue;
      }
      const bool resets = command.UserCallback == ImDrawCallback_ResetRenderState;
      state = resets ? 0 : mixed(state, reinterpret_cast<std::uintptr_t>(command.UserCallback));
      if (!resets) tiles.add(clip_of(command, size), mixed(state, hash_of_clip(clip_of(command, size))));
    }
  }
  const int across = tiles.across(), down = tiles.down();
  std::vector<std::uint64_t> hashes = std::move(tiles).take();
  // Clip rectangles come back from pixels exactly at these scales only.
  const bool is_exact = size.scale.x == size.scale.y && (size.scale.x == 1 || size.scale.x == 2);
  const bool is_whole = !is_exact || hashes.size() != hashes_.size() || size.width != width_ || size.height != height_;
  std::vector<bool> changed(hashes.size());
  for (std::size_t k = 0; k < hashes.size(); ++k) changed[k] = is_whole || hashes[k] != hashes_[k];
  hashes_ = std::move(hashes);
  width_ = size.width;
  height_ = size.height;
  std::vector<PixelRect> rects = rects_of(changed, across, down);
  for (PixelRect& r : rects)
    r = common({kTile * r.x0, kTile * r.y0, kTile * r.x1, kTile * r.y1}, {0, 0, size.width, size.height});
  return rects;
}

void reduce_to(const std::vector<PixelRect>& rects, ImDrawData& frame) {
  const FrameSize size = size_of(frame);
  for (int n = 0; n < frame.CmdListsCount; ++n) {
    ImDrawList& list = *frame.CmdLists[n];
    ImVector<ImDrawCmd> commands;
    ImVector<ImDrawIdx> indices;
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback == ImDrawCallback_ResetRenderState) {
        commands.push_back(command);
        continue;
      }
      const PixelRect clip = clip_of(command, size);
      for (const PixelRect& rect : rects) {
        const PixelRect part = common(clip, rect);
        if (part.is_empty()) continue;
        if (command.UserCallback == nullptr) {
          add_part(list, command, part, size, commands, indices);
        } else {
          commands.push_back(command);
          commands.back().ClipRect = clip_of(part, size);
        }
      }
    }
    list.CmdBuffer.swap(commands);
    list.IdxBuffer.swap(indices);
  }
}

}  // namespace contrejour::studio
