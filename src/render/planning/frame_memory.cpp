// SPDX-License-Identifier: Apache-2.0
#include "render/planning/frame_memory.h"

#include <utility>

namespace contrejour::inline internal {
namespace {

struct FrameMemory {
  struct Key {
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit FrameMemory(const Key& /*key*/) {}
  [[nodiscard]] std::size_t memory_bytes() const { return image.pixels.size() * sizeof(float); }
  Image image;
};

}  // namespace

Image unwritten_image(RenderCache& cache, int width, int height) {
  Image& kept = cache.section<FrameMemory>({})->image;
  if (kept.width == width && kept.height == height && kept.channels == 3) return std::exchange(kept, {});
  return Image::unwritten(width, height);
}

void keep_memory(RenderCache& cache, Image image) { cache.section<FrameMemory>({})->image = std::move(image); }

}  // namespace contrejour::inline internal
