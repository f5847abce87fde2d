// SPDX-License-Identifier: Apache-2.0
// Rasterises polygons tile by tile. In each row an edge adds coverage times irradiance to the few pixels near it, and
// changes the linear function that the light is along the row beyond. One pass along the rows then turns the changes of
// all polygons into pixels. A polygon thus costs what its outline costs, not its area, and overlapping ghosts share the
// pass. Accuracy: the coverage of a pixel by a polygon is exact; irradiance is that at the pixel's centre; sums are in
// double precision.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/pool.h"
#include "render/polygons/rasteriser.h"

namespace contrejour::inline internal::adaptive {

// Divides the frame into rectangles whose sums stay in the cache.
struct TileGrid {
  static constexpr int kWidth = 512;
  static constexpr int kHeight = 64;

  int width = 0, height = 0;  // pixels
  int columns = 0, rows = 0;  // tiles

  TileGrid(int w, int h) : width(w), height(h), columns((w + kWidth - 1) / kWidth), rows((h + kHeight - 1) / kHeight) {}
  [[nodiscard]] std::size_t count() const { return index(0, rows); }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

// The tiles under the bounding box of a polygon, including the last ones; none if x1 < x0.
struct TileRange {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
};
[[nodiscard]] TileRange tiles_under(std::span<const Point> corners, const TileGrid& grid);

// For each tile the polygons of a list that may touch it, in the list's order: index[start[t] .. start[t + 1]).
struct TileLists {
  std::vector<std::uint32_t> start, index;
  [[nodiscard]] std::size_t bytes() const { return (start.size() + index.size()) * sizeof(std::uint32_t); }
};

[[nodiscard]] TileLists tile_lists(const PolygonList& list, const TileGrid& grid);

struct TiledPolygons {
  PolygonList list;
  TileLists tiles;
};

// The input from which all tiles of a batch are drawn.
struct TileInput {
  std::span<const TiledPolygons> lists;
  std::span<const TextureTable* const> textures;  // by Pattern::table
  const OutlineTable* outline;  // null: no pattern refers to it
};

struct TileCanvas;
struct TileSums;

class TileRasteriser final : public Rasteriser {
 public:
  TileRasteriser();
  ~TileRasteriser() override;

  [[nodiscard]] std::unique_ptr<PolygonBatch> new_batch(int width, int height, const PatternAtlas* atlas) override;
  [[nodiscard]] std::size_t bytes() const;  // of scratch memory

 private:
  Pool<TileSums> sums_;  // a megabyte each, all zero between uses: one a thread instead of one a row
};

}  // namespace contrejour::inline internal::adaptive
