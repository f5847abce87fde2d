// SPDX-License-Identifier: Apache-2.0
#include "image/pixel_pool.h"

#include <new>

#include "base/memory.h"

namespace contrejour::detail {

void* PixelPool::take(std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  auto best = kept_.end();
  for (auto block = kept_.begin(); block != kept_.end(); ++block) {
    const bool fits = block->bytes >= bytes && block->bytes / kLeastPart <= bytes;
    if (fits && (best == kept_.end() || block->bytes <= best->bytes)) best = block;
  }
  Block block{nullptr, bytes, frame_};
  if (best != kept_.end()) {
    block = *best;
    kept_.erase(best);
    kept_bytes_ -= block.bytes;
  } else {
    block.memory = allocate_large(bytes);
  }
  try {
    lent_.emplace(block.memory, block.bytes);
  } catch (const std::bad_alloc&) {
    free_large(block.memory);
    throw;
  }
  return block.memory;
}

void PixelPool::give_back(void* memory) noexcept {
  const std::scoped_lock lock(mutex_);
  const auto lent = lent_.find(memory);
  const std::size_t bytes = lent->second;
  lent_.erase(lent);
  if (is_closed_ || bytes > kMaxBytes) return free_large(memory);
  while (kept_bytes_ > kMaxBytes - bytes) free_oldest();
  try {
    kept_.push_back({memory, bytes, frame_});
    kept_bytes_ += bytes;
  } catch (const std::bad_alloc&) {
    free_large(memory);
  }
}

void PixelPool::next_frame() {
  const std::scoped_lock lock(mutex_);
  ++frame_;
  while (!kept_.empty() && kept_.front().used + kFrames <= frame_) free_oldest();
}

void PixelPool::close() noexcept {
  const std::scoped_lock lock(mutex_);
  is_closed_ = true;
  while (!kept_.empty()) free_oldest();
}

std::size_t PixelPool::bytes() const {
  const std::scoped_lock lock(mutex_);
  return kept_bytes_;
}

void PixelPool::free_oldest() noexcept {
  kept_bytes_ -= kept_.front().bytes;
  free_large(kept_.front().memory);
  kept_.erase(kept_.begin());
}

void* allocate_pixels(std::size_t bytes, const std::shared_ptr<PixelPool>& pool) {
  return pool ? pool->take(bytes) : allocate_large(bytes);
}

void free_pixels(void* pixels, const std::shared_ptr<PixelPool>& pool) noexcept {
  if (pool && pixels != nullptr) return pool->give_back(pixels);
  free_large(pixels);
}

}  // namespace contrejour::detail
