#include "render/adaptive/tiles.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/adaptive/tiles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef CONTREJOUR_ADAPTIVE_TILE_AREA
#define CONTREJOUR_ADAPTIVE_TILE_AREA
namespace contrejour::adaptive {

// A tile's place in the frame, and its sums.
struct TileSums {
  static constexpr std::size_t kLanes = 8;  // three channels and a spare: level, then slope along x
  static constexpr std::size_t kPitch = TileGrid::kWidth + 2;  // what edges on the right border change is not read

  int x0 = 0, y0 = 0, width = 0, height = 0;
  std::vector<double> sums = std::vector<double>(kLanes * kPitch * TileGrid::kHeight, 0.0);

  [[nodiscard]] double* at(int row, int column) {
    return sums.data() + kLanes * (static_cast<std::size_t>(row) * kPitch + static_cast<std::size_t>(column));
  }
};

}  // namespace contrejour::adaptive
#endif

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, TileSums::kLanes>;

// A polygon's irradiance as what a row of pixels needs: level and slope along x, and how the level changes by row.
struct RowShade {
  HWY_ALIGN double level[TileSums::kLanes] = {};
  HWY_ALIGN double by_row[TileSums::kLanes] = {};
};

HWY_INLINE RowShade row_shade(const Shade& shade, const TileSums& tile) {
  RowShade out;
  const double x = static_cast<double>(shade.at.x) - tile.x0 - 0.5;  // pixel centres
  const double y = static_cast<double>(shade.at.y) - tile.y0 - 0.5;
  for (std::size_t c = 0; c < 3; ++c) {
    const double slope = shade.along_x[c];
    out.level[c] = shade.value[c] - slope * x - shade.along_y[c] * y;
    out.level[4 + c] = slope;
    out.by_row[c] = shade.along_y[c];
  }
  return out;
}

// Adds `cover` of the row's irradiance to one column's sums.
HWY_INLINE void add(double* to, const double* shade, double cover) {
  const Tag d;
  for (std::size_t k = 0; k < TileSums::kLanes; k += hn::Lanes(d)) {
    hn::StoreU(hn::MulAdd(hn::Load(d, shade + k), hn::Set(d, cover), hn::LoadU(d, to + k)), d, to + k);
  }
}

// One stretch of an edge within a row of pixels, from x0 to x1 and dy high: coverage to its right, as differences.
HWY_INLINE void add_stretch(double* row, const double* shade, double x0, double x1, double dy) {
  if (x0 > x1) std::swap(x0, x1);
  const auto first = static_cast<int>(x0);
  const auto last = static_cast<int>(x1);
  const auto column = [&](int k) { return row + TileSums::kLanes * static_cast<std::size_t>(k); };
  if (first == last) {
    const double right = dy * (0.5 * (x0 + x1) - first);
    add(column(first), shade, dy - right);
    add(column(first + 1), shade, right);
    return;
  }
  const double slope = dy / (x1 - x0);
  const double in_first = first + 1 - x0;
  double before = 0.5 * slope * in_first * in_first;
  double filled = slope * in_first;
  add(column(first), shade, before);
  for (int k = first + 1; k < last; ++k) {
    const double covered = filled + 0.5 * slope;
    add(column(k), shade, covered - before);
    before = covered;
    filled += slope;
  }
  const double in_last = x1 - last;
  const double covered = dy - 0.5 * slope * in_last * in_last;
  add(column(last), shade, covered - before);
  add(column(last + 1), shade, dy - covered);
}

// An edge inside the tile's columns, from a down to b, clipped to its rows.
HWY_INLINE void add_edge(TileSums& tile, const RowShade& shade, Vec2 a, Vec2 b, double sign) {
  const double dx_dy = (b.x - a.x) / (b.y - a.y);
  const double top = std::max(a.y, 0.0);
  const double bottom = std::min(b.y, static_cast<double>(tile.height));
  const double low = std::min(a.x, b.x);
  const double high = std::max(a.x, b.x);
  double y = top;
  double x = std::clamp(a.x + dx_dy * (top - a.y), low, high);
  HWY_ALIGN double at_row[TileSums::kLanes];
  const Tag d;
  for (int row = static_cast<int>(top); y < bottom; ++row) {
    const double y_next = std::min<double>(row + 1, bottom);
    const double x_next = std::clamp(a.x + dx_dy * (y_next - a.y), low, high);
    for (std::size_t k = 0; k < TileSums::kLanes; k += hn::Lanes(d)) {
      hn::Store(hn::MulAdd(hn::Load(d, shade.by_row + k), hn::Set(d, row), hn::Load(d, shade.level + k)), d,
                at_row + k);
    }
    add_stretch(tile.at(row, 0), at_row, x, x_next, sign * (y_next - y));
    x = x_next;
    y = y_next;
  }
}

// Parts of an edge left of the tile count as on its border, parts to the right do not count.
void add_clipped(TileSums& tile, const RowShade& shade, Vec2 a, Vec2 b, double sign) {
  const double width = tile.width;
  if (a.y > b.y) {
    std::swap(a, b);
    sign = -sign;
  }
  if (!(a.y < b.y) || b.y <= 0.0 || a.y >= tile.height || (a.x >= width && b.x >= width)) return;
  const double low = std::min(a.x, b.x);
  const double high = std::max(a.x, b.x);
  if (low >= 0.0 && high < width) return add_edge(tile, shade, a, b, sign);
  if (high <= 0.0) return add_edge(tile, shade, {0.0, a.y}, {0.0, b.y}, sign);
  const auto at_x = [&](double x) {
    return Vec2{x, std::clamp(a.y + (x - a.x) * (b.y - a.y) / (b.x - a.x), a.y, b.y)};
  };
  const Vec2 left = low < 0.0 ? at_x(0.0) : (a.x < b.x ? a : b);
  const Vec2 right = high >= width ? at_x(width) : (a.x < b.x ? b : a);
  const Vec2 upper = left.y < right.y ? left : right;
  const Vec2 lower = left.y < right.y ? right : left;
  if (upper.y < lower.y) add_edge(tile, shade, upper, lower, sign);
  if (low >= 0.0) return;
  if (a.x < 0.0 && a.y < left.y) add_edge(tile, shade, {0.0, a.y}, {0.0, left.y}, sign);
  if (b.x < 0.0 && left.y < b.y) add_edge(tile, shade, {0.0, left.y}, {0.0, b.y}, sign);
}

void add_polygon(TileSums& tile, const PolygonList& list, const Polygon& polygon) {
  const auto corners = list.corners_of(polygon);
  const auto corner = [&](std::size_t k) {
    return Vec2{static_cast<double>(corners[k].x) - tile.x0, static_cast<double>(corners[k].y) - tile.y0};
  };
  const RowShade shade = row_shade(polygon.shade, tile);
  if (corners.size() == 1) {
    const auto column = static_cast<int>(std::floor(corner(0).x));
    const auto row = static_cast<int>(std::floor(corner(0).y));
    if (column < 0 || row < 0 || column >= tile.width || row >= tile.height) return;
    add(tile.at(row, column), shade.level, 1.0);
    add(tile.at(row, column + 1), shade.level, -1.0);
    return;
  }
  double twice_area = 0.0;
  for (std::size_t k = 2; k < corners.size(); ++k)
    twice_area += cross(corner(k - 1) - corner(0), corner(k) - corner(0));
  const double sign = twice_area > 0.0 ? -1.0 : 1.0;  // y down in memory: left edges rise
  for (std::size_t k = 0; k < corners.size(); ++k) {
    add_clipped(tile, shade, corner(k), corner(k + 1 == corners.size() ? 0 : k + 1), sign);
  }
}

// Running sums into pixels; the sums are cleared.
void sum_up(TileSums& tile, Image& image) {
  constexpr std::size_t kHalf = TileSums::kLanes / 2;
  const hn::CappedTag<double, kHalf> d;
  HWY_ALIGN double pixels[kHalf * TileGrid::kWidth];
  const auto width = static_cast<std::size_t>(tile.width);
  for (int row = 0; row < tile.height; ++row) {
    double* sums = tile.at(row, 0);
    for (std::size_t k = 0; k < kHalf; k += hn::Lanes(d)) {
      auto level = hn::Zero(d);
      auto slope = hn::Zero(d);
      auto x = hn::Zero(d);
      for (std::size_t column = 0; column < width; ++column) {
        level = hn::Add(level, hn::LoadU(d, sums + TileSums::kLanes * column + k));
        slope = hn::Add(slope, hn::LoadU(d, sums + TileSums::kLanes * column + kHalf + k));
        hn::Store(hn::MulAdd(slope, x, level), d, pixels + kHalf * column + k);
        x = hn::Add(x, hn::Set(d, 1.0));
      }
    }
    std::fill_n(sums, TileSums::kLanes * (width + 1), 0.0);
    float* to = image.pixels.data() + image.index(tile.x0, tile.y0 + row);
    for (std::size_t column = 0; column < width; ++column) {
      for (std::size_t c = 0; c < 3; ++c) to[3 * column + c] += static_cast<float>(pixels[kHalf * column + c]);
    }
  }
}

void draw_tile(std::span<const TiledPolygons> lists, std::size_t at, TileSums& tile, Image& image) {
  bool any = false;
  for (const TiledPolygons& p : lists) {
    for (std::uint32_t k = p.tiles.start[at]; k < p.tiles.start[at + 1]; ++k) {
      add_polygon(tile, p.list, p.list.polygons[p.tiles.index[k]]);
      any = true;
    }
  }
  if (any) sum_up(tile, image);
}

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::adaptive {
namespace {

HWY_EXPORT(draw_tile);

// The tiles under a polygon's bounds.
struct TileRange {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;  // inclusive
};

TileRange range_of(std::span<const Point> corners, const TileGrid& grid) {
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

}  // namespace

// Counts, then fills.
TileLists tile_lists(const PolygonList& list, const TileGrid& grid) {
  TileLists out;
  out.start.assign(grid.count() + 1, 0);
  std::vector<TileRange> ranges;
  ranges.reserve(list.polygons.size());
  const auto for_each_tile = [&](const TileRange& r, auto visit) {
    for (int y = r.y0; y <= r.y1; ++y) {
      for (int x = r.x0; x <= r.x1; ++x) visit(static_cast<std::size_t>(y * grid.columns + x));
    }
  };
  for (const Polygon& p : list.polygons) {
    ranges.push_back(range_of(list.corners_of(p), grid));
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

void add_tile_row(std::span<const TiledPolygons> lists, const TileGrid& grid, int row, Image& image) {
  TileSums sums;
  sums.y0 = row * TileGrid::kHeight;
  sums.height = std::min(TileGrid::kHeight, grid.height - sums.y0);
  for (int column = 0; column < grid.columns; ++column) {
    sums.x0 = column * TileGrid::kWidth;
    sums.width = std::min(TileGrid::kWidth, grid.width - sums.x0);
    HWY_DYNAMIC_DISPATCH(draw_tile)(lists, static_cast<std::size_t>(row * grid.columns + column), sums, image);
  }
}

}  // namespace contrejour::adaptive
#endif  // HWY_ONCE
