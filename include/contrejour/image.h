// SPDX-License-Identifier: Apache-2.0
// Scene-linear float images, interleaved, rows from the top. Values in, values out.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "contrejour/export.h"

namespace contrejour {

namespace detail {
class PixelPool;  // the memory that a renderer uses again for its next frames
[[nodiscard]] CONTREJOUR_API void* allocate_pixels(std::size_t bytes, const std::shared_ptr<PixelPool>& pool);
CONTREJOUR_API void free_pixels(void* pixels, const std::shared_ptr<PixelPool>& pool) noexcept;
}  // namespace detail

// Allocates pictures in the system's large pages where it has them: a 4K picture takes 25000 small pages, each of which
// costs a page fault. Elements constructed without a value are not cleared. The memory of a renderer's pictures goes
// back to the renderer when they are destroyed, by whichever thread; copies of a picture have memory of their own.
template <class T>
class PixelAllocator {
 public:
  using value_type = T;
  // Memory is freed by the allocator that it came from, so this moves with it.
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  PixelAllocator() = default;
  explicit PixelAllocator(std::shared_ptr<detail::PixelPool> pool) : pool_(std::move(pool)) {}
  PixelAllocator(const PixelAllocator&) = default;  // and no moves: an allocator that was moved from must stay equal
  PixelAllocator& operator=(const PixelAllocator&) = default;
  ~PixelAllocator() = default;
  template <class U>
  explicit PixelAllocator(const PixelAllocator<U>& other) : pool_(other.pool()) {}

  [[nodiscard]] PixelAllocator select_on_container_copy_construction() const { return {}; }
  [[nodiscard]] const std::shared_ptr<detail::PixelPool>& pool() const { return pool_; }

  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(detail::allocate_pixels(count * sizeof(T), pool_));
  }
  void deallocate(T* pixels, std::size_t /*count*/) noexcept { detail::free_pixels(pixels, pool_); }
  void construct(T* at) noexcept { ::new (static_cast<void*>(at)) T; }
  template <class... From>
  void construct(T* at, From&&... from) {
    ::new (static_cast<void*>(at)) T(std::forward<From>(from)...);
  }
  friend bool operator==(const PixelAllocator& a, const PixelAllocator& b) { return a.pool_ == b.pool_; }

 private:
  std::shared_ptr<detail::PixelPool> pool_;
};

using Pixels = std::vector<float, PixelAllocator<float>>;

struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;
  Pixels pixels;  // [(y * width + x) * channels + c]

  Image() = default;
  Image(int w, int h, int c = 3)
      : width(w), height(h), channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), 0.0F) {}

  // Leaves the pixels uninitialised, for callers that write them all.
  [[nodiscard]] static Image unwritten(int w, int h, int c = 3) {
    Image image;
    image.width = w;
    image.height = h;
    image.channels = c;
    image.pixels = Pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c));
    return image;
  }

  [[nodiscard]] std::size_t index(int x, int y, int c = 0) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(c);
  }
  [[nodiscard]] float& at(int x, int y, int c = 0) { return pixels[index(x, y, c)]; }
  [[nodiscard]] float at(int x, int y, int c = 0) const { return pixels[index(x, y, c)]; }
  [[nodiscard]] std::span<float> row(int y) {
    return {pixels.data() + index(0, y), static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)};
  }
  [[nodiscard]] std::span<const float> row(int y) const {
    return {pixels.data() + index(0, y), static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)};
  }
};

}  // namespace contrejour
