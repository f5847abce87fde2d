// SPDX-License-Identifier: Apache-2.0
// What a cache keeps from frame to frame, and when a section is replaced.
#include <memory>
#include <string>

#include <doctest/doctest.h>

#include "render/planning/render_cache.h"

using namespace contrejour;

namespace {

struct Squares {
  using Key = int;
  explicit Squares(int key) : value(key * key) {}
  int value;
};

struct Names {
  using Key = std::string;
  explicit Names(const std::string& key) : value(key) {}
  std::string value;
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
