// SPDX-License-Identifier: Apache-2.0
#include "render/planning/frame_memory.h"

#include <memory>

#include "image/pixel_pool.h"

namespace contrejour::inline internal {
namespace {

struct FrameMemory {
  struct Key {
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit FrameMemory(const Key& /*key*/) {}
  FrameMemory(const FrameMemory&) = delete;
  FrameMemory& operator=(const FrameMemory&) = delete;
  ~FrameMemory() { pool->close(); }

  void next_frame() const { pool->next_frame(); }
  [[nodiscard]] std::size_t memory_bytes() const { return pool->bytes(); }

  std::shared_ptr<detail::PixelPool> pool = std::make_shared<detail::PixelPool>();
};

}  // namespace

Image unwritten_image(RenderCache& cache, int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  const std::size_t samples = image.index(0, height);
  image.pixels = Pixels(samples, PixelAllocator<float>(cache.section<FrameMemory>({})->pool));
  return image;
}

}  // namespace contrejour::inline internal
