// SPDX-License-Identifier: Apache-2.0
// What a cache keeps from frame to frame, and when a section is replaced.
#include <memory>
#include <string>

#include <doctest/doctest.h>

#include "base/number_key.h"
#include "base/recently_used.h"
#include "render/planning/render_cache.h"

using namespace contrejour;

namespace {

struct Squares {
  using Key = int;
  explicit Squares(int key) : value(key * key) {}
  void next_frame() { ++frames; }
  [[nodiscard]] static std::size_t memory_bytes() { return 100; }
  int value, frames = 0;
};

struct Names {
  using Key = std::string;
  explicit Names(const std::string& key) : value(key) {}
  [[nodiscard]] std::size_t memory_bytes() const { return value.size(); }
  std::string value;
};

struct Heavy {
  using Key = int;
  static constexpr std::size_t kMaxBytes = 1000;
  explicit Heavy(int key) : bytes(static_cast<std::size_t>(key)) {}
  [[nodiscard]] std::size_t memory_bytes() const { return bytes; }
  std::size_t bytes;
};

}  // namespace

TEST_CASE("a cache keeps a section as long as its key is the same") {
  RenderCache cache;
  CHECK(cache.find<Squares>() == nullptr);
  const auto first = cache.section<Squares>(3);
  first->value = 10;
  CHECK(cache.section<Squares>(3) == first);
  CHECK(cache.find<Squares>() == first);
  const auto second = cache.section<Squares>(4);
  CHECK(second->value == 16);
  CHECK(cache.find<Squares>() == second);
  CHECK(first->value == 10);  // a holder of a section keeps it
  CHECK(cache.section<Squares>(3)->value == 9);
}

TEST_CASE("sections of different types do not meet") {
  RenderCache cache;
  const auto squares = cache.section<Squares>(3);
  CHECK(cache.section<Names>("iris")->value == "iris");
  CHECK(cache.section<Names>("dirt")->value == "dirt");
  CHECK(cache.section<Squares>(3) == squares);
  CHECK(RenderCache().find<Names>() == nullptr);
}

TEST_CASE("a cache adds up its sections' memory and calls those that count frames") {
  RenderCache cache;
  CHECK(cache.memory_bytes() == 0);
  const auto squares = cache.section<Squares>(3);
  (void)cache.section<Names>("iris");
  CHECK(cache.memory_bytes() == 104);
  cache.next_frame();
  cache.next_frame();
  CHECK(squares->frames == 2);
}

TEST_CASE("a section that has grown too large is dropped before the next frame") {
  RenderCache cache;
  const auto heavy = cache.section<Heavy>(900);
  cache.next_frame();
  CHECK(cache.section<Heavy>(900) == heavy);
  heavy->bytes = 1001;
  CHECK(cache.section<Heavy>(900) == heavy);
  cache.next_frame();
  CHECK(cache.find<Heavy>() == nullptr);
  CHECK(cache.section<Heavy>(900)->bytes == 900);
  CHECK(heavy->bytes == 1001);  // a holder of a section keeps it
}

TEST_CASE("what frames use is kept, what they do not use is dropped, and no more than fits") {
  RecentlyUsed<NumberKey, int> kept(1000);
  kept.keep({1.0}, 1, 400);
  kept.keep({2.0}, 2, 400);
  kept.keep({3.0}, 3, 400);  // beyond the limit
  kept.keep({1.0}, 5, 400);  // the key has a value
  CHECK(kept.find({1.0}) == 1);
  CHECK(!kept.find({3.0}));
  CHECK(kept.bytes() == 800);
  for (std::uint64_t frame = 0; frame < 2 * RecentlyUsed<NumberKey, int>::kFrames; ++frame) {
    kept.next_frame();
    CHECK(kept.find({2.0}) == 2);
  }
  CHECK(!kept.find({1.0}));
  CHECK(kept.bytes() == 400);
  kept.keep({3.0}, 3, 400);
  CHECK(kept.find({3.0}) == 3);
}

TEST_CASE("numbers as keys differ by any bit") {
  CHECK(NumberKey{1.0, 2.0} == NumberKey{1.0, 2.0});
  CHECK(NumberKey{0.0} != NumberKey{-0.0});
  CHECK(NumberKey{1.0} != NumberKey{1.0, 0.0});
}
