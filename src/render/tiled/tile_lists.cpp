// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/tile_lists.h"

#include <algorithm>

#include "base/tasks.h"

namespace contrejour::inline internal::tiled {
namespace {

constexpr std::size_t kPrimitivesPerChunk = 8192;
constexpr std::size_t kMaxCounters = 1U << 22U;  // 16 MiB

template <class Visit>
void for_each_tile(const PixelRange& tiles, int columns, Visit visit) {
  for (int y = tiles.y0; y <= tiles.y1; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns);
    for (int x = tiles.x0; x <= tiles.x1; ++x) visit(row + static_cast<std::size_t>(x));
  }
}

PixelRange overlap(const PixelRange& a, const PixelRange& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace

// Chunks of primitives are counted in parallel, each into its own counters; a tile's list is the concatenation of the
// chunks' lists in order.
bool list_by_tile(std::span<const Primitive> primitives, const TileGrid& grid, const Context& context, TileLists& out) {
  const std::size_t tiles = grid.count();
  const std::size_t max_chunks = std::max<std::size_t>(1, kMaxCounters / std::max<std::size_t>(1, tiles));
  const std::size_t chunks =
      std::clamp<std::size_t>((primitives.size() + kPrimitivesPerChunk - 1) / kPrimitivesPerChunk, 1, max_chunks);
  const auto chunk_begin = [&](std::size_t c) { return primitives.size() * c / chunks; };
  std::vector<std::uint32_t> counters(chunks * tiles);

  const bool counted = parallel_for(chunks, context, [&](std::size_t c) {
    std::uint32_t* count = counters.data() + c * tiles;
    for (std::size_t k = chunk_begin(c); k < chunk_begin(c + 1); ++k) {
      for_each_tile(grid.tiles_of(primitives[k].pixels), grid.columns(), [&](std::size_t t) { ++count[t]; });
    }
  });
  if (!counted) return false;

  out.begin.resize(tiles + 1);
  std::uint32_t sum = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    out.begin[t] = sum;
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::uint32_t count = counters[c * tiles + t];
      counters[c * tiles + t] = sum;
      sum += count;
    }
  }
  out.begin[tiles] = sum;
  out.indices.resize(sum);

  return parallel_for(chunks, context, [&](std::size_t c) {
    std::uint32_t* next = counters.data() + c * tiles;
    for (std::size_t k = chunk_begin(c); k < chunk_begin(c + 1); ++k) {
      for_each_tile(grid.tiles_of(primitives[k].pixels), grid.columns(),
                    [&](std::size_t t) { out.indices[next[t]++] = static_cast<std::uint32_t>(k); });
    }
  });
}

// Every small tile belongs to one coarse tile, so that coarse tiles can be counted and filled in parallel.
bool refine_lists(std::span<const Primitive> primitives, const TileGrid& coarse_grid, const TileLists& coarse,
                  const TileGrid& grid, const Context& context, TileLists& out) {
  const int ratio = coarse_grid.tile / grid.tile;
  const auto dense_tiles_of = [&](std::size_t k) {
    const int x = static_cast<int>(k) % coarse_grid.columns() * ratio;
    const int y = static_cast<int>(k) / coarse_grid.columns() * ratio;
    return PixelRange{x, y, std::min(x + ratio, grid.columns()) - 1, std::min(y + ratio, grid.rows()) - 1};
  };
  const auto visit = [&](std::size_t k, auto&& see) {
    const PixelRange within = dense_tiles_of(k);
    for (const std::uint32_t index : coarse.of(k)) {
      const PixelRange tiles = overlap(grid.tiles_of(primitives[index].pixels), within);
      for_each_tile(tiles, grid.columns(), [&](std::size_t t) { see(t, index); });
    }
  };

  std::vector<std::uint32_t> next(grid.count());
  if (!parallel_for(coarse_grid.count(), context,
                    [&](std::size_t k) { visit(k, [&](std::size_t t, std::uint32_t) { ++next[t]; }); })) {
    return false;
  }
  out.begin.resize(next.size() + 1);
  std::uint32_t sum = 0;
  for (std::size_t t = 0; t < next.size(); ++t) {
    out.begin[t] = sum;
    sum += next[t];
    next[t] = out.begin[t];
  }
  out.begin[next.size()] = sum;
  out.indices.resize(sum);
  return parallel_for(coarse_grid.count(), context, [&](std::size_t k) {
    visit(k, [&](std::size_t t, std::uint32_t index) { out.indices[next[t]++] = index; });
  });
}

}  // namespace contrejour::inline internal::tiled
