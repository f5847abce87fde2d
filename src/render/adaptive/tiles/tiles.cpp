// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/tiles/tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/simd_targets.h"
#include "base/tasks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/adaptive/tiles/tiles.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/adaptive/tiles/tile_canvas.h"
#include "render/adaptive/tiles/tile_edges-inl.h"
#include "render/adaptive/tiles/tile_patterned-inl.h"
#include "render/adaptive/tiles/tile_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

void add_polygon(TileSums& tile, const PolygonList& list, const Polygon& polygon) {
  const auto corners = list.corners_of(polygon);
  const RowIrradiance irradiance = row_irradiance(list.irradiance_of(polygon), tile);
  if (corners.size() == 1) {
    const auto column = static_cast<int>(std::floor(static_cast<double>(corners[0].x) - tile.x0));
    const auto row = static_cast<int>(std::floor(static_cast<double>(corners[0].y) - tile.y0));
    if (column < 0 || row < 0 || column >= tile.width || row >= tile.height) return;
    double* const pixel = tile.pixels_at(row) + TileSums::kPixel * static_cast<std::size_t>(column);
    (DoubleChannelVector::load(pixel) + irradiance.at(row).at(column)).store(pixel);
    tile.touch(row, column / TileSums::kBlock, column / TileSums::kBlock);
    return;
  }
  for_each_edge(tile, list, polygon, [&](Vec2 a, Vec2 b, std::size_t corner, double sign) {
    const std::uint32_t neighbour = list.neighbour_of(polygon.first + corner);
    if (neighbour == PolygonList::kSkipped) return;
    const bool alone = neighbour == PolygonList::kUnshared;
    add_clipped(tile,
                alone ? irradiance : irradiance - row_irradiance(list.irradiance_of(list.polygons[neighbour]), tile), a,
                b, sign);
  });
}

// Prefetches the polygons of a tile that come soon, since they lie far apart in memory.
HWY_INLINE void fetch_ahead(const TiledPolygons& p, std::uint32_t k, std::uint32_t end) {
  constexpr std::uint32_t kPolygon = 8, kRest = 4;  // polygons ahead
  if (k + kPolygon < end) hwy::Prefetch(&p.list.polygons[p.tiles.index[k + kPolygon]]);
  if (k + kRest >= end) return;
  const Polygon& polygon = p.list.polygons[p.tiles.index[k + kRest]];
  hwy::Prefetch(p.list.corners.data() + polygon.first);
  hwy::Prefetch(&p.list.irradiance_of(polygon));
  if (polygon.pattern != 0) hwy::Prefetch(&p.list.patterns[polygon.pattern - 1]);
}

void draw_tile(const TileInput& input, std::size_t at, TileSums& tile, const TileCanvas& canvas) {
  bool any = false;
  for (const TiledPolygons& p : input.lists) {
    for (std::uint32_t k = p.tiles.start[at]; k < p.tiles.start[at + 1]; ++k) {
      fetch_ahead(p, k, p.tiles.start[at + 1]);
      const Polygon& polygon = p.list.polygons[p.tiles.index[k]];
      if (polygon.pattern != 0)
        add_patterned(tile, p.list, polygon, input);
      else
        add_polygon(tile, p.list, polygon);
      any = true;
    }
  }
  if (any) return draw_pixels(tile, canvas);
  tile.carried = {};  // all polygons end before this tile: only rounding is left
  if (canvas.mode == RasterMode::Write) canvas.clear(tile);
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::adaptive {
namespace {

HWY_EXPORT(draw_tile);

}  // namespace

TileRange tiles_under(std::span<const Point> corners, const TileGrid& grid) {
  Point low = corners[0];
  Point high = corners[0];
  for (const Point p : corners) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto w = static_cast<float>(grid.width);
  const auto h = static_cast<float>(grid.height);
  if (!(high.x >= 0.0F && high.y >= 0.0F && low.x < w && low.y < h)) return {};
  const auto tile = [](float v, float size, int length) {
    return static_cast<int>(std::clamp(v, 0.0F, size - 1.0F)) / length;
  };
  return {tile(low.x, w, TileGrid::kWidth), tile(low.y, h, TileGrid::kHeight), tile(high.x, w, TileGrid::kWidth),
          tile(high.y, h, TileGrid::kHeight)};
}

// Counts the polygons of each tile, then fills the lists.
TileLists tile_lists(const PolygonList& list, const TileGrid& grid) {
  TileLists out;
  out.start.assign(grid.count() + 1, 0);
  std::vector<TileRange> ranges;
  ranges.reserve(list.polygons.size());
  const auto for_each_tile = [&](const TileRange& r, auto visit) {
    for (int y = r.y0; y <= r.y1; ++y) {
      for (int x = r.x0; x <= r.x1; ++x) visit(grid.index(x, y));
    }
  };
  for (const Polygon& p : list.polygons) {
    ranges.push_back(tiles_under(list.corners_of(p), grid));
    for_each_tile(ranges.back(), [&](std::size_t t) { ++out.start[t + 1]; });
  }
  for (std::size_t t = 0; t < grid.count(); ++t) out.start[t + 1] += out.start[t];
  out.index.resize(out.start.back());
  std::vector<std::uint32_t> next(out.start.begin(), out.start.end() - 1);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    for_each_tile(ranges[k], [&](std::size_t t) { out.index[next[t]++] = static_cast<std::uint32_t>(k); });
  }
  return out;
}

namespace {

class TiledBatch final : public PolygonBatch {
 public:
  TiledBatch(const TileGrid& grid, const PatternAtlas* atlas, Pool<TileSums>& sums)
      : grid_(grid), atlas_(atlas), sums_(sums) {}

  void extend(std::size_t lists) override { lists_.resize(lists_.size() + lists, {{}, tile_lists({}, grid_)}); }
  void set(std::size_t list, PolygonList polygons) override {
    lists_[list].list = std::move(polygons);
    lists_[list].tiles = tile_lists(lists_[list].list, grid_);
  }
  [[nodiscard]] std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const TiledPolygons& p : lists_) sum += p.list.bytes() + p.tiles.bytes();
    return sum;
  }
  [[nodiscard]] PixelArea touched() const override;
  void draw(RasterMode mode, const Context& context, const RasterTarget& target) override;

 private:
  void draw_row(const TileInput& input, int row, const TileCanvas& canvas);

  TileGrid grid_;
  const PatternAtlas* atlas_;
  Pool<TileSums>& sums_;
  std::vector<TiledPolygons> lists_;
};

PixelArea TiledBatch::touched() const {
  TileRange lit{grid_.columns, grid_.rows, -1, -1};
  for (int y = 0; y < grid_.rows; ++y) {
    for (int x = 0; x < grid_.columns; ++x) {
      const std::size_t at = grid_.index(x, y);
      const auto touches = [&](const TiledPolygons& p) { return p.tiles.start[at] != p.tiles.start[at + 1]; };
      if (std::ranges::any_of(lists_, touches))
        lit = {std::min(lit.x0, x), std::min(lit.y0, y), std::max(lit.x1, x), std::max(lit.y1, y)};
    }
  }
  if (lit.x1 < lit.x0) return {};
  return {lit.x0 * TileGrid::kWidth, lit.y0 * TileGrid::kHeight, std::min((lit.x1 + 1) * TileGrid::kWidth, grid_.width),
          std::min((lit.y1 + 1) * TileGrid::kHeight, grid_.height)};
}

void TiledBatch::draw(RasterMode mode, const Context& context, const RasterTarget& target) {
  const auto textures = atlas_ != nullptr ? atlas_->textures() : std::vector<const TextureTable*>{};
  const TileInput input{lists_, textures, atlas_ != nullptr ? &atlas_->outline() : nullptr};
  Context quiet = context;
  quiet.progress = {};
  const int first = target.top / TileGrid::kHeight;
  const int last = (target.top + target.image.height + TileGrid::kHeight - 1) / TileGrid::kHeight;
  parallel_for(static_cast<std::size_t>(last - first), quiet, [&](std::size_t at) {
    // One canvas a thread, since a writer belongs to one.
    draw_row(input, first + static_cast<int>(at), TileCanvas(target, mode));
  });
}

void TiledBatch::draw_row(const TileInput& input, int row, const TileCanvas& canvas) {
  const auto lent = sums_.lend();
  TileSums& sums = *lent;
  sums.y0 = row * TileGrid::kHeight;
  sums.height = std::min(TileGrid::kHeight, grid_.height - sums.y0);
  sums.carried = {};
  for (int column = 0; column < grid_.columns; ++column) {
    sums.x0 = column * TileGrid::kWidth;
    sums.width = std::min(TileGrid::kWidth, grid_.width - sums.x0);
    HWY_DYNAMIC_DISPATCH(draw_tile)(input, grid_.index(column, row), sums, canvas);
  }
}

}  // namespace

TileRasteriser::TileRasteriser() = default;
TileRasteriser::~TileRasteriser() = default;

std::size_t TileRasteriser::bytes() const {
  return sums_.bytes([](const TileSums& sums) { return sums.bytes(); });
}

std::unique_ptr<PolygonBatch> TileRasteriser::new_batch(int width, int height, const PatternAtlas* atlas) {
  return std::make_unique<TiledBatch>(TileGrid(width, height), atlas, sums_);
}

}  // namespace contrejour::inline internal::adaptive
#endif  // HWY_ONCE
