// SPDX-License-Identifier: Apache-2.0
// Lists by tile against their definition.
#include <array>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "render/tiled/tile_lists.h"

using namespace contrejour;
using tiled::PixelRange;
using tiled::Primitive;
using tiled::TileGrid;
using tiled::TileLists;

namespace {

Frame frame_of(int width, int height) {
  Frame frame;
  frame.width = frame.full_width = width;
  frame.height = frame.full_height = height;
  return frame;
}

// Small and huge ones, inside and outside the frame, points, lines, and corners that are not numbers.
std::vector<Primitive> random_primitives(int count, const Frame& frame, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  constexpr std::array kSizes{0.0F, 0.3F, 2.0F, 20.0F, 500.0F, 1e9F, 1e30F};
  std::vector<Primitive> list;
  for (int k = 0; k < count; ++k) {
    const float size = kSizes[static_cast<std::size_t>(k) % kSizes.size()];
    const float x = static_cast<float>(frame.width) * (0.5F + unit(random));
    const float y = static_cast<float>(frame.height) * (0.5F + unit(random));
    Primitive p;
    for (std::size_t i = 0; i < 4; ++i) {
      p.x[i] = x + size * unit(random);
      p.y[i] = k % 5 == 0 ? y : y + size * unit(random);
    }
    if (k % 31 == 0) p.x[static_cast<std::size_t>(k) % 4] = std::numeric_limits<float>::quiet_NaN();
    if (k % 37 == 0) p.y[static_cast<std::size_t>(k) % 4] = std::numeric_limits<float>::infinity();
    p.pixels = tiled::pixels_within(p.x, p.y, frame);
    list.push_back(p);
  }
  return list;
}

bool holds_a_middle(const Primitive& p, const TileGrid& grid, int column, int row) {
  const auto within = [](const std::array<float, 4>& c, int pixel) {
    bool below = false;
    bool above = false;
    for (const float v : c) {
      if (v != v) return false;
      below = below || v <= static_cast<float>(pixel) + 0.5F;
      above = above || v >= static_cast<float>(pixel) + 0.5F;
    }
    return below && above;
  };
  for (int y = row * grid.tile; y < std::min((row + 1) * grid.tile, grid.height); ++y) {
    for (int x = column * grid.tile; x < std::min((column + 1) * grid.tile, grid.width); ++x) {
      if (within(p.x, x) && within(p.y, y)) return true;
    }
  }
  return false;
}

void check_against_definition(const std::vector<Primitive>& primitives, const TileGrid& grid, const TileLists& lists) {
  REQUIRE(lists.begin.size() == grid.count() + 1);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      std::vector<std::uint32_t> expected;
      for (std::size_t k = 0; k < primitives.size(); ++k) {
        if (holds_a_middle(primitives[k], grid, column, row)) expected.push_back(static_cast<std::uint32_t>(k));
      }
      const auto list = lists.of(static_cast<std::size_t>(row * grid.columns() + column));
      CHECK(std::vector<std::uint32_t>(list.begin(), list.end()) == expected);
    }
  }
}

}  // namespace

TEST_CASE("lists are exactly the primitives whose bounds hold a pixel's middle, with coarse tiles and without") {
  for (const auto& [width, height] : {std::pair{61, 37}, std::pair{1, 1}, std::pair{64, 64}, std::pair{100, 3}}) {
    const Frame frame = frame_of(width, height);
    const auto primitives = random_primitives(300, frame, 5);
    for (const auto& [dense, coarse] : {std::pair{8, 32}, std::pair{8, 8}, std::pair{5, 15}, std::pair{64, 128}}) {
      CAPTURE(width);
      CAPTURE(dense);
      const TileGrid grid{width, height, dense};
      const TileGrid larger{width, height, coarse};
      TileLists direct, first, second;
      REQUIRE(list_by_tile(primitives, grid, {}, direct));
      REQUIRE(list_by_tile(primitives, larger, {}, first));
      REQUIRE(refine_lists(primitives, larger, first, grid, {}, second));
      check_against_definition(primitives, grid, direct);
      CHECK(second.begin == direct.begin);
      CHECK(second.indices == direct.indices);
    }
  }
}

TEST_CASE("many primitives in many chunks make the same lists for any number of threads") {
  const Frame frame = frame_of(300, 200);
  const auto primitives = random_primitives(30000, frame, 9);
  const TileGrid grid{300, 200, 8};
  const TileGrid larger{300, 200, 128};
  TileLists first;
  Context context;
  context.threads = 1;
  REQUIRE(list_by_tile(primitives, grid, context, first));
  std::uint64_t indices = 0;
  for (const Primitive& p : primitives) indices += grid.tile_count_of(p.pixels);
  CHECK(first.indices.size() == indices);
  for (const int threads : {2, 7}) {
    context.threads = threads;
    TileLists direct, coarse, refined;
    REQUIRE(list_by_tile(primitives, grid, context, direct));
    REQUIRE(list_by_tile(primitives, larger, context, coarse));
    REQUIRE(refine_lists(primitives, larger, coarse, grid, context, refined));
    CHECK(direct.indices == first.indices);
    CHECK(refined.indices == first.indices);
  }
}
