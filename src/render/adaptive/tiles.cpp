#include "render/adaptive/tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "kernels/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/adaptive/tiles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef CONTREJOUR_ADAPTIVE_TILE_AREA
#define CONTREJOUR_ADAPTIVE_TILE_AREA
namespace contrejour::adaptive {

// A polygon's coverage alone, as changes along the rows of a tile.
struct CoverSums {
  static constexpr std::size_t kLanes = 1;
  static constexpr std::size_t kPitch = TileGrid::kWidth + 2;

  int width = 0, height = 0;
  std::vector<double> sums;  // made with the first polygon

  void make() {
    if (sums.empty()) sums.resize(kPitch * TileGrid::kHeight, 0.0);
  }
  [[nodiscard]] double* at(int row, int column) {
    return sums.data() + static_cast<std::size_t>(row) * kPitch + static_cast<std::size_t>(column);
  }
  void touch(int /*row*/, int /*first*/, int /*last*/) {}
};

// A tile's place in the frame, and its sums.
struct TileSums {
  static constexpr std::size_t kLanes = 8;  // three channels and a spare: level, then slope along x
  static constexpr std::size_t kPitch = TileGrid::kWidth + 2;  // what edges on the right border change is not read

  static constexpr std::size_t kPixel = kLanes / 2;  // values of a pixel
  static constexpr int kBlock = 8;  // columns
  static constexpr double kUnseenCover = 1e-7;  // of a pixel: rounding beside a polygon
  static_assert(TileGrid::kWidth <= 64 * kBlock);

  int x0 = 0, y0 = 0, width = 0, height = 0;
  std::array<std::uint64_t, TileGrid::kHeight> touched{};  // by row, a bit for each block of columns with changes
  std::vector<double> sums = std::vector<double>(kLanes * kPitch * TileGrid::kHeight, 0.0);
  std::vector<float> behind_screens;  // light that came pixel by pixel, four values each; empty: none yet
  bool any_behind_screens = false;
  CoverSums cover;

  [[nodiscard]] double* at(int row, int column) {
    return sums.data() + kLanes * (static_cast<std::size_t>(row) * kPitch + static_cast<std::size_t>(column));
  }
  // Columns first to last, last one included and the right border's left out.
  void touch(int row, int first, int last) {
    const int most = TileGrid::kWidth / kBlock - 1;
    const int low = first / kBlock;
    const int high = std::min(last / kBlock, most);
    touched[static_cast<std::size_t>(row)] |= (~std::uint64_t{0} >> (most - high)) & (~std::uint64_t{0} << low);
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
template <class Sums>
HWY_INLINE void add(double* to, const double* shade, double cover) {
  if constexpr (Sums::kLanes == 1) {
    *to += cover;
    return;
  }
  const Tag d;
  for (std::size_t k = 0; k < TileSums::kLanes; k += hn::Lanes(d)) {
    hn::StoreU(hn::MulAdd(hn::Load(d, shade + k), hn::Set(d, cover), hn::LoadU(d, to + k)), d, to + k);
  }
}

// One stretch of an edge within a row of pixels, from x0 to x1 and dy high: coverage to its right, as differences.
template <class Sums>
HWY_INLINE void add_stretch(Sums& tile, int at_row, const double* shade, double x0, double x1, double dy) {
  if (x0 > x1) std::swap(x0, x1);
  const auto first = static_cast<int>(x0);
  const auto last = static_cast<int>(x1);
  double* row = tile.at(at_row, 0);
  tile.touch(at_row, first, last + 1);
  const auto column = [&](int k) { return row + Sums::kLanes * static_cast<std::size_t>(k); };
  if (first == last) {
    const double right = dy * (0.5 * (x0 + x1) - first);
    add<Sums>(column(first), shade, dy - right);
    add<Sums>(column(first + 1), shade, right);
    return;
  }
  const double slope = dy / (x1 - x0);
  const double in_first = first + 1 - x0;
  double before = 0.5 * slope * in_first * in_first;
  double filled = slope * in_first;
  add<Sums>(column(first), shade, before);
  for (int k = first + 1; k < last; ++k) {
    const double covered = filled + 0.5 * slope;
    add<Sums>(column(k), shade, covered - before);
    before = covered;
    filled += slope;
  }
  const double in_last = x1 - last;
  const double covered = dy - 0.5 * slope * in_last * in_last;
  add<Sums>(column(last), shade, covered - before);
  add<Sums>(column(last + 1), shade, dy - covered);
}

// An edge inside the tile's columns, from a down to b, clipped to its rows.
template <class Sums>
HWY_INLINE void add_edge(Sums& tile, const RowShade& shade, Vec2 a, Vec2 b, double sign) {
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
    for (std::size_t k = 0; Sums::kLanes > 1 && k < TileSums::kLanes; k += hn::Lanes(d)) {
      hn::Store(hn::MulAdd(hn::Load(d, shade.by_row + k), hn::Set(d, row), hn::Load(d, shade.level + k)), d,
                at_row + k);
    }
    add_stretch(tile, row, at_row, x, x_next, sign * (y_next - y));
    x = x_next;
    y = y_next;
  }
}

// Parts of an edge left of the tile count as on its border, parts to the right do not count.
template <class Sums>
void add_clipped(Sums& tile, const RowShade& shade, Vec2 a, Vec2 b, double sign) {
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
    tile.touch(row, column, column + 1);
    add<TileSums>(tile.at(row, column), shade.level, 1.0);
    add<TileSums>(tile.at(row, column + 1), shade.level, -1.0);
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

// A polygon behind a screen: its coverage first, alone in `cover`, then pixel by pixel the light that passes.
// share: what passes at a pixel's middle.
template <class Share>
void add_shared(TileSums& tile, const PolygonList& list, const Polygon& polygon, const Share& share) {
  const auto corners = list.corners_of(polygon);
  const auto corner = [&](std::size_t k) {
    return Vec2{static_cast<double>(corners[k].x) - tile.x0, static_cast<double>(corners[k].y) - tile.y0};
  };
  if (tile.behind_screens.empty())
    tile.behind_screens.resize(TileSums::kPixel * TileGrid::kWidth * TileGrid::kHeight, 0.0F);
  tile.any_behind_screens = true;
  CoverSums& cover = tile.cover;
  cover.width = tile.width;
  cover.height = tile.height;
  cover.make();
  double twice_area = 0.0;
  for (std::size_t k = 2; k < corners.size(); ++k)
    twice_area += cross(corner(k - 1) - corner(0), corner(k) - corner(0));
  const double sign = twice_area > 0.0 ? -1.0 : 1.0;
  Vec2 low = corner(0), high = corner(0);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    low = {std::min(low.x, corner(k).x), std::min(low.y, corner(k).y)};
    high = {std::max(high.x, corner(k).x), std::max(high.y, corner(k).y)};
    add_clipped(cover, RowShade{}, corner(k), corner(k + 1 == corners.size() ? 0 : k + 1), sign);
  }
  const auto within = [](double v, int size) {
    return static_cast<int>(std::clamp(std::floor(v), 0.0, static_cast<double>(size)));
  };
  const int first = within(low.x, tile.width), last = within(high.x, tile.width - 1);
  const int bottom = within(high.y, tile.height - 1);
  const RowShade shade = row_shade(polygon.shade, tile);
  for (int row = within(low.y, tile.height); row <= bottom; ++row) {
    double covered = 0.0;
    double* const changes = cover.at(row, 0);
    float* to = tile.behind_screens.data() + TileSums::kPixel * static_cast<std::size_t>(row * TileGrid::kWidth);
    for (int column = first; column <= last; ++column) {
      covered += changes[column];
      changes[column] = 0.0;
      if (!(covered > TileSums::kUnseenCover)) continue;
      const auto passed = share({tile.x0 + column + 0.5, tile.y0 + row + 0.5});
      for (std::size_t c = 0; c < 3; ++c)
        to[TileSums::kPixel * static_cast<std::size_t>(column) + c] += static_cast<float>(
            covered * passed[c] * (shade.level[c] + shade.by_row[c] * row + shade.level[4 + c] * column));
    }
    changes[last + 1] = 0.0;
  }
}

void add_screened(TileSums& tile, const PolygonList& list, const Polygon& polygon) {
  if (polygon.screened > 0) {
    const PolygonList::Screened& screened = list.screened[static_cast<std::size_t>(polygon.screened - 1)];
    std::array<StopPlace, kMaxStopCrossings> room;
    return add_shared(tile, list, polygon,
                      [&](Vec2 pixel) { return screened.screen->share(screened.map.places(pixel, room)); });
  }
  const PolygonList::Fringed& fringed = list.fringed[static_cast<std::size_t>(-polygon.screened - 1)];
  const EdgeTable& table = *fringed.table;
  const IrisShape& iris = table.iris();
  const auto place = [&](Vec2 pixel) {
    return fringed.at_origin + fringed.along_x * pixel.x + fringed.along_y * pixel.y;
  };
  if (iris.is_picture())
    return add_shared(tile, list, polygon, [&](Vec2 pixel) {
      EdgeTable::Rgb share{1.0F, 1.0F, 1.0F};
      table.apply(iris.picture_distance(place(pixel)), share);
      return share;
    });
  const std::uint16_t* const active = list.bounds.data() + fringed.first;
  if (fringed.count == 1 && iris.bounds()[active[0]].straight()) {
    const IrisBound& bound = iris.bounds()[active[0]];
    const double at_origin = bound.distance(fringed.at_origin);
    const Vec2 slope{dot(bound.normal, fringed.along_x), dot(bound.normal, fringed.along_y)};
    return add_shared(tile, list, polygon, [&](Vec2 pixel) {
      EdgeTable::Rgb share{1.0F, 1.0F, 1.0F};
      table.apply(at_origin + dot(slope, pixel), share);
      return share;
    });
  }
  add_shared(tile, list, polygon, [&](Vec2 pixel) {
    EdgeTable::Rgb share{1.0F, 1.0F, 1.0F};
    const Vec2 p = place(pixel);
    for (std::uint32_t k = 0; k < fringed.count; ++k) table.apply(iris.bounds()[active[k]].distance(p), share);
    return share;
  });
}

// Running sums of a row, each pixel as four floats to where `store` puts them; the sums are cleared. Blocks without
// changes are not looked at: reading and clearing them is most of the work.
template <class Store>
HWY_INLINE void sum_row(double* sums, std::uint64_t touched, int width, Store store) {
  constexpr std::size_t kHalf = TileSums::kLanes / 2;
  const hn::CappedTag<double, kHalf> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0);
  for (std::size_t k = 0; k < kHalf; k += hn::Lanes(d)) {
    auto level = zero;
    auto slope = zero;
    auto x = zero;
    for (int block = 0; block * TileSums::kBlock < width; ++block) {
      const auto first = static_cast<std::size_t>(block * TileSums::kBlock);
      const auto end = std::min(first + TileSums::kBlock, static_cast<std::size_t>(width));
      const bool changes = (touched >> block & 1U) != 0;
      for (std::size_t column = first; column < end; ++column) {
        if (changes) {
          double* at = sums + TileSums::kLanes * column + k;
          level = hn::Add(level, hn::LoadU(d, at));
          slope = hn::Add(slope, hn::LoadU(d, at + kHalf));
          hn::StoreU(zero, d, at);
          hn::StoreU(zero, d, at + kHalf);
        }
        store(df, hn::DemoteTo(df, hn::MulAdd(slope, x, level)), column, k);
        x = hn::Add(x, one);
      }
    }
  }
}

// Light that came pixel by pixel; it is cleared.
void add_behind_screens(TileSums& tile, int row, float* rgb) {
  float* const from = tile.behind_screens.data() + TileSums::kPixel * static_cast<std::size_t>(row * TileGrid::kWidth);
  for (std::size_t column = 0; column < static_cast<std::size_t>(tile.width); ++column)
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * column + c] += from[TileSums::kPixel * column + c];
  std::fill_n(from, TileSums::kPixel * static_cast<std::size_t>(tile.width), 0.0F);
}

void sum_up(TileSums& tile, TileMode mode, Image& image) {
  const bool behind_screens = std::exchange(tile.any_behind_screens, false);
  constexpr std::size_t kPixel = TileSums::kLanes / 2;
  // With whole pixels a store the fourth value is overwritten by the next pixel; the last one's stays beside the
  // picture.
  constexpr bool kWholePixels = hn::MaxLanes(hn::CappedTag<double, kPixel>()) == kPixel;
  HWY_ALIGN float pixels[kPixel * TileGrid::kWidth];
  const auto last = static_cast<std::size_t>(tile.width - 1);
  for (int row = 0; row < tile.height; ++row) {
    const auto at_row = static_cast<std::size_t>(row);
    float* to = image.pixels.data() + image.index(tile.x0, tile.y0 + row);
    const auto into = [&](auto place) {
      sum_row(tile.at(row, 0), tile.touched[at_row], tile.width,
              [&](auto d, auto value, std::size_t column, std::size_t k) { hn::StoreU(value, d, place(column) + k); });
    };
    if (kWholePixels && mode == TileMode::Write) {
      into([&](std::size_t column) { return column == last ? pixels : to + 3 * column; });
      std::copy_n(pixels, 3, to + 3 * last);
    } else {
      into([&](std::size_t column) { return pixels + kPixel * column; });
      for (std::size_t k = 0; k < 3 * (last + 1); ++k) {
        const float value = pixels[kPixel * (k / 3) + k % 3];
        to[k] = mode == TileMode::Write ? value : to[k] + value;
      }
    }
    std::fill_n(tile.at(row, tile.width), TileSums::kLanes, 0.0);  // what edges on the right border changed
    tile.touched[at_row] = 0;
    if (behind_screens) add_behind_screens(tile, row, to);
  }
}

void clear(const TileSums& tile, Image& image) {
  for (int row = 0; row < tile.height; ++row) {
    std::fill_n(image.pixels.data() + image.index(tile.x0, tile.y0 + row), 3 * static_cast<std::size_t>(tile.width),
                0.0F);
  }
}

void draw_tile(std::span<const TiledPolygons> lists, std::size_t at, TileSums& tile, TileMode mode, Image& image) {
  bool any = false;
  for (const TiledPolygons& p : lists) {
    for (std::uint32_t k = p.tiles.start[at]; k < p.tiles.start[at + 1]; ++k) {
      const Polygon& polygon = p.list.polygons[p.tiles.index[k]];
      if (polygon.screened != 0)
        add_screened(tile, p.list, polygon);
      else
        add_polygon(tile, p.list, polygon);
      any = true;
    }
  }
  if (any) return sum_up(tile, mode, image);
  if (mode == TileMode::Write) clear(tile, image);
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

TileDrawer::TileDrawer(const TileGrid& grid) : grid_(grid) {}
TileDrawer::~TileDrawer() = default;

std::unique_ptr<TileSums> TileDrawer::take() {
  const std::lock_guard lock(mutex_);
  if (unused_.empty()) return std::make_unique<TileSums>();
  auto sums = std::move(unused_.back());
  unused_.pop_back();
  return sums;
}

void TileDrawer::give_back(std::unique_ptr<TileSums> sums) {
  const std::lock_guard lock(mutex_);
  unused_.push_back(std::move(sums));
}

void TileDrawer::draw_rows(std::span<const TiledPolygons> lists, int first, int last, TileMode mode, Image& image) {
  auto taken = take();
  TileSums& sums = *taken;
  for (int row = first; row < last; ++row) {
    sums.y0 = row * TileGrid::kHeight;
    sums.height = std::min(TileGrid::kHeight, grid_.height - sums.y0);
    for (int column = 0; column < grid_.columns; ++column) {
      sums.x0 = column * TileGrid::kWidth;
      sums.width = std::min(TileGrid::kWidth, grid_.width - sums.x0);
      const auto tile = static_cast<std::size_t>(row * grid_.columns + column);
      HWY_DYNAMIC_DISPATCH(draw_tile)(lists, tile, sums, mode, image);
    }
  }
  give_back(std::move(taken));
}

}  // namespace contrejour::adaptive
#endif  // HWY_ONCE
