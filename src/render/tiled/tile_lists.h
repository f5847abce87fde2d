// SPDX-License-Identifier: Apache-2.0
// Lists the primitives that touch each tile of the frame: bodonyi2023 4.3. A primitive touches a tile when the middle
// of one of the tile's pixels lies within the primitive's bounds. Lists are counted, then filled, so that no primitive
// is ever left out; each list is in the order of the primitives, whatever the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "render/tiled/primitive.h"

namespace contrejour::inline internal::tiled {

// Square tiles over a frame, rows from the top; the last tile of a row or a column may be cut off.
struct TileGrid {
  int width = 0, height = 0;  // of the frame, pixels
  int tile = 8;               // pixels a side

  [[nodiscard]] int columns() const { return (width + tile - 1) / tile; }
  [[nodiscard]] int rows() const { return (height + tile - 1) / tile; }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
  }
  // Tiles that hold these pixels, as a range of columns and rows.
  [[nodiscard]] PixelRange tiles_of(const PixelRange& pixels) const {
    if (pixels.empty()) return {};
    return {pixels.x0 / tile, pixels.y0 / tile, pixels.x1 / tile, pixels.y1 / tile};
  }
  [[nodiscard]] std::uint64_t tile_count_of(const PixelRange& pixels) const {
    const PixelRange t = tiles_of(pixels);
    if (t.empty()) return 0;
    return static_cast<std::uint64_t>(t.x1 - t.x0 + 1) * static_cast<std::uint64_t>(t.y1 - t.y0 + 1);
  }
};

struct TileLists {
  std::vector<std::uint32_t> begin;  // one for each tile, and the end of the last
  std::vector<std::uint32_t> indices;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t tile) const {
    return std::span(indices).subspan(begin[tile], begin[tile + 1] - begin[tile]);
  }
  [[nodiscard]] std::uint64_t bytes() const { return (begin.size() + indices.size()) * sizeof(std::uint32_t); }
};

// Builds the lists from the primitives. Returns false when the context is cancelled; the lists are then undefined.
bool list_by_tile(std::span<const Primitive> primitives, const TileGrid& grid, const Context& context, TileLists& out);

// Builds the lists from those of larger tiles, whose size is a multiple of the grid's.
bool refine_lists(std::span<const Primitive> primitives, const TileGrid& coarse_grid, const TileLists& coarse,
                  const TileGrid& grid, const Context& context, TileLists& out);

}  // namespace contrejour::inline internal::tiled
