// SPDX-License-Identifier: Apache-2.0
// Memory of pictures that comes back when they are destroyed, and is used again.
#include "image/pixel_pool.h"

#include <cstddef>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using namespace contrejour;
using detail::PixelPool;

namespace {

Pixels pixels_of(const std::shared_ptr<PixelPool>& pool, std::size_t count) {
  return Pixels(count, PixelAllocator<float>(pool));  // a vector of its size, not of its arguments
}

constexpr std::size_t kCount = 3000;

}  // namespace

TEST_CASE("a picture's memory comes back, from any thread, and serves the next one that it fits") {
  const auto pool = std::make_shared<PixelPool>();
  Pixels first = pixels_of(pool, kCount);
  const float* const memory = first.data();
  CHECK(pool->bytes() == 0);
  std::thread([&] { const Pixels gone = std::move(first); }).join();
  CHECK(pool->bytes() == kCount * sizeof(float));
  {
    CHECK(pixels_of(pool, kCount / 2 - 1).data() != memory);  // less than half of it
    CHECK(pixels_of(pool, kCount + 1).data() != memory);
    const Pixels second = pixels_of(pool, kCount - 100);
    CHECK(second.data() == memory);
  }
  CHECK(pixels_of(pool, kCount).data() == memory);  // which is still as large as it was
}

TEST_CASE("memory stays with the picture that moves, and a copy has its own") {
  const auto pool = std::make_shared<PixelPool>();
  Image image;
  image = Image(2, 2);  // from elsewhere, and replaced below
  image.pixels = pixels_of(pool, 12);
  const float* const memory = image.pixels.data();
  Image copy = image;
  CHECK(copy.pixels.get_allocator().pool() == nullptr);
  Image moved = std::move(image);
  CHECK(moved.pixels.data() == memory);
  std::swap(copy, moved);
  copy = {};
  CHECK(pool->bytes() == 12 * sizeof(float));
  CHECK(moved.pixels.size() == 12);
}

TEST_CASE("no more is kept than the limit, and nothing that four frames did not need") {
  const auto pool = std::make_shared<PixelPool>();
  constexpr std::size_t kLarge = (PixelPool::kMaxBytes / 4 + 4096) / sizeof(float);
  {
    std::vector<Pixels> at_once;
    for (int k = 0; k < 6; ++k) at_once.push_back(pixels_of(pool, kLarge));
    const Pixels too_large = pixels_of(pool, PixelPool::kMaxBytes / sizeof(float) + 1);
  }
  CHECK(pool->bytes() == 3 * kLarge * sizeof(float));
  for (int frame = 0; frame < 3; ++frame) {
    pool->next_frame();
    const Pixels used = pixels_of(pool, kLarge);
  }
  CHECK(pool->bytes() == 3 * kLarge * sizeof(float));
  pool->next_frame();
  CHECK(pool->bytes() == kLarge * sizeof(float));  // the only one of those three that was used
}

TEST_CASE("pictures outlive the renderer whose memory they have") {
  auto pool = std::make_shared<PixelPool>();
  Pixels alive = pixels_of(pool, kCount);
  {
    const Pixels kept = pixels_of(pool, kCount);
  }
  pool->close();
  CHECK(pool->bytes() == 0);
  alive[kCount - 1] = 1.0F;
  alive = Pixels();
  CHECK(pool->bytes() == 0);
}
