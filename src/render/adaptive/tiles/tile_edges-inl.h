// SPDX-License-Identifier: Apache-2.0
// Adds a polygon's edges as coverage times irradiance, and as changes of the light beyond, along the rows of a tile.
#if defined(CONTREJOUR_ADAPTIVE_TILE_EDGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_EDGES_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_EDGES_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_EDGES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/adaptive/tiles/channel_vector-inl.h"
#include "render/adaptive/tiles/pixels-inl.h"
#include "render/adaptive/tiles/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

// The irradiance of a polygon in the form that a row of pixels needs: a line along x, and its change by row.
struct RowIrradiance {
  ChannelLine<double> line;
  DoubleChannelVector by_row;

  [[nodiscard]] HWY_INLINE ChannelLine<double> at(int row) const {
    return {multiply_add(by_row, DoubleChannelVector::all(row), line.level), line.slope};
  }
  // The change across an edge from polygon b to polygon a.
  friend HWY_INLINE RowIrradiance operator-(const RowIrradiance& a, const RowIrradiance& b) {
    return {a.line - b.line, a.by_row - b.by_row};
  }
};

HWY_INLINE RowIrradiance row_irradiance(const LinearIrradiance& irradiance, const TileSums& tile) {
  const auto x = DoubleChannelVector::all(tile.x0 + 0.5 - static_cast<double>(irradiance.at.x));  // pixel centres
  const auto y = DoubleChannelVector::all(tile.y0 + 0.5 - static_cast<double>(irradiance.at.y));
  const auto along_x = to_doubles(irradiance.along_x.data()), along_y = to_doubles(irradiance.along_y.data());
  const auto level = multiply_add(along_x, x, multiply_add(along_y, y, to_doubles(irradiance.value.data())));
  return {{level, along_x}, along_y};
}

// The coverage by a segment of an edge within a row of pixels: it rises from the left end on, and is `all` beyond.
struct StretchCover {
  double to_left;  // from the first counted column
  double width;
  double all, half_slope;  // half of the rise over a column

  // The coverage of neighbouring columns from `first` on.
  [[nodiscard]] HWY_INLINE hn::Vec<RowTag<double>> at(int first) const {
    const RowTag<double> d;
    const auto none = hn::Zero(d), one = hn::Set(d, 1.0), end = hn::Set(d, width);
    const auto within = [&](hn::Vec<RowTag<double>> u) HWY_ATTR { return hn::Min(hn::Max(u, none), end); };
    const auto u = hn::Sub(hn::Iota(d, static_cast<double>(first)), hn::Set(d, to_left)), next = hn::Add(u, one);
    const auto here = within(u), after = within(next);
    const auto beyond = hn::Min(hn::Max(hn::Sub(next, end), none), one);  // exact to the last bit where it is `all`
    const auto slope = hn::Mul(hn::Set(d, half_slope), hn::Mul(hn::Sub(after, here), hn::Add(after, here)));
    return hn::MulAdd(hn::Set(d, all), beyond, slope);
  }
};

// The segments, in several rows at once, of an edge inside the tile's columns that leads down, clipped to the tile's
// rows.
class EdgeRows {
 public:
  static constexpr int kAtOnce = static_cast<int>(hn::MaxLanes(RowTag<double>()));

  HWY_INLINE EdgeRows(const TileSums& tile, Vec2 a, Vec2 b)
      : a_(a), top_(std::max(a.y, 0.0)), bottom_(std::min(b.y, static_cast<double>(tile.height))),
        low_(std::min(a.x, b.x)), high_(std::max(a.x, b.x)), dx_dy_((b.x - a.x) / (b.y - a.y)),
        last_block_(tile.blocks() - 1) {}

  [[nodiscard]] HWY_INLINE int first_row() const { return static_cast<int>(top_); }
  [[nodiscard]] HWY_INLINE int end_row() const { return static_cast<int>(std::ceil(bottom_)); }
  HWY_INLINE void set_rows(int first) {
    const Tag d;
    const IndexTag di;
    const auto row = hn::Iota(d, static_cast<double>(first));
    const auto y0 = hn::Max(row, hn::Set(d, top_));
    const auto y1 = hn::Min(hn::Add(row, hn::Set(d, 1.0)), hn::Set(d, bottom_));
    const auto x_at = [&](hn::Vec<Tag> y) HWY_ATTR {
      const auto x = hn::MulAdd(hn::Set(d, dx_dy_), hn::Sub(y, hn::Set(d, a_.y)), hn::Set(d, a_.x));
      return hn::Min(hn::Max(x, hn::Set(d, low_)), hn::Set(d, high_));
    };
    const auto x0 = x_at(y0), x1 = x_at(y1);
    const auto left = hn::Min(x0, x1), right = hn::Max(x0, x1);
    const auto block_at = [&](hn::Vec<Tag> x) HWY_ATTR {
      return hn::Min(hn::DemoteTo(di, hn::Mul(x, hn::Set(d, 1.0 / TileSums::kBlock))), hn::Set(di, last_block_));
    };
    const auto first_block = block_at(left);
    hn::Store(first_block, di, first_);
    hn::Store(block_at(right), di, last_);
    const auto from = hn::Mul(hn::PromoteTo(d, first_block), hn::Set(d, double{TileSums::kBlock}));
    hn::Store(hn::Sub(left, from), d, to_left_);
    hn::Store(hn::Sub(right, left), d, width_);
    hn::Store(hn::Sub(y1, y0), d, height_);
  }
  [[nodiscard]] HWY_INLINE int first_block(int k) const { return first_[k]; }
  [[nodiscard]] HWY_INLINE int last_block(int k) const { return last_[k]; }
  [[nodiscard]] HWY_INLINE double height(int k) const { return height_[k]; }
  // The coverage in row k; columns are counted from the segment's first block.
  [[nodiscard]] HWY_INLINE StretchCover cover(int k, double all, double half_slope) const {
    return {to_left_[k], width_[k], all, half_slope};
  }

 private:
  using Tag = RowTag<double>;
  using IndexTag = hn::Rebind<std::int32_t, Tag>;
  Vec2 a_;
  double top_, bottom_, low_, high_, dx_dy_;
  int last_block_;
  HWY_ALIGN double to_left_[kAtOnce], width_[kAtOnce], height_[kAtOnce];
  HWY_ALIGN std::int32_t first_[kAtOnce], last_[kAtOnce];
};

// Adds the change of a row's pixels that a segment makes. Columns are counted from the first block.
HWY_INLINE void add_stretch(TileSums& tile, int row, int first_block, int last_block, const StretchCover& cover,
                            const PixelLine<double>& light) {
  using Pixels = PixelsOf<double>;
  double* to = tile.pixels_at(row) + TileSums::kPixel * static_cast<std::size_t>(TileSums::kBlock * first_block);
  const int columns = TileSums::kBlock * (last_block + 1 - first_block);
  for (int column = 0; column < columns; column += Pixels::kCount, to += kChannels * Pixels::kLanes)
    multiply_add(Pixels::of(cover.at(column)), light.at(column), Pixels::load(to)).store(to);
  tile.touch(row, first_block, last_block);
}

HWY_INLINE void add_change(TileSums& tile, int row, int block, const ChannelLine<double>& line, double times) {
  double* const change = tile.change_after(row, block);
  add_times(ChannelLine<double>::load(change), line, times).store(change);
}

// Adds a step at a column's left border that extends over all of the row's height.
HWY_INLINE void add_step(TileSums& tile, int row, int column, const ChannelLine<double>& line, double times) {
  const int block = std::min(column / TileSums::kBlock, tile.blocks() - 1), from = TileSums::kBlock * block;
  const PixelLine<double> light(ChannelLine<double>{line.at(from), line.slope});
  add_stretch(tile, row, block, block, {static_cast<double>(column - from), 0.0, times, 0.0}, light);
  add_change(tile, row, block, line, times);
}

HWY_INLINE void add_edge(TileSums& tile, const RowIrradiance& irradiance, Vec2 a, Vec2 b, double sign) {
  constexpr double kSteepest = 1e100;  // its square is still finite
  EdgeRows rows(tile, a, b);
  const int first = rows.first_row(), end = rows.end_row();
  const double dx = std::abs(b.x - a.x);
  const double half_slope = dx != 0.0 ? 0.5 * sign * std::min((b.y - a.y) / dx, kSteepest) : 0.0;
  const PixelLine<double> light(irradiance.line);
  const auto by_row = PixelsOf<double>::each(irradiance.by_row);
  for (int row = first; row < end;) {
    rows.set_rows(row);
    const int count = std::min(EdgeRows::kAtOnce, end - row);
    for (int k = 0; k < count; ++k, ++row) {
      const int first_block = rows.first_block(k), last_block = rows.last_block(k);
      const double all = sign * rows.height(k);
      add_stretch(tile, row, first_block, last_block, rows.cover(k, all, half_slope),
                  light.raised(by_row, row).from(TileSums::kBlock * first_block));
      add_change(tile, row, last_block, irradiance.at(row), all);
    }
  }
}

// Adds an edge that for_each_edge() visits. Parts of it left of the tile count as on the tile's border, or not at all
// where sums are carried from tile to tile; parts to the right do not count. For coverage alone, add_edge() is in
// tile_cover-inl.h.
template <class Sums, class AnyIrradiance>
void add_clipped(Sums& tile, const AnyIrradiance& irradiance, Vec2 a, Vec2 b, double sign) {
  const double width = tile.width;
  if (a.y > b.y) {
    std::swap(a, b);
    sign = -sign;
  }
  const double low = std::min(a.x, b.x);
  const double high = std::max(a.x, b.x);
  if (low >= 0.0 && high < width) return add_edge(tile, irradiance, a, b, sign);
  if (high <= 0.0 && tile.is_carried()) return;
  if (high <= 0.0) return add_edge(tile, irradiance, {0.0, a.y}, {0.0, b.y}, sign);
  const auto at_x = [&](double x) {
    return Vec2{x, std::clamp(a.y + (x - a.x) * (b.y - a.y) / (b.x - a.x), a.y, b.y)};
  };
  const Vec2 left = low < 0.0 ? at_x(0.0) : (a.x < b.x ? a : b);
  const Vec2 right = high >= width ? at_x(width) : (a.x < b.x ? b : a);
  const Vec2 upper = left.y < right.y ? left : right;
  const Vec2 lower = left.y < right.y ? right : left;
  if (upper.y < lower.y) add_edge(tile, irradiance, upper, lower, sign);
  if (low >= 0.0 || tile.is_carried()) return;
  if (a.x < 0.0 && a.y < left.y) add_edge(tile, irradiance, {0.0, a.y}, {0.0, left.y}, sign);
  if (b.x < 0.0 && left.y < b.y) add_edge(tile, irradiance, {0.0, left.y}, {0.0, b.y}, sign);
}

// Visits the polygon's edges that cross the tile's rows left of its right border, with their ends relative to the
// tile's corner, the index of the first corner, and the sign of their coverage.
template <class Visit>
HWY_INLINE void for_each_edge(const TileSums& tile, const PolygonList& list, const Polygon& polygon,
                              const Visit& visit) {
  const auto corners = list.corners_of(polygon);
  const auto from_tile = [&](Point p) {
    return Vec2{static_cast<double>(p.x) - tile.x0, static_cast<double>(p.y) - tile.y0};
  };
  const double sign = polygon.turns_left ? -1.0 : 1.0;  // y points down in memory: left edges rise
  const auto top = static_cast<float>(tile.y0), bottom = static_cast<float>(tile.y0 + tile.height);
  const auto right = static_cast<float>(tile.x0 + tile.width);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point a = corners[k], b = corners[k + 1 == corners.size() ? 0 : k + 1];
    const float from = std::min(a.y, b.y), to = std::max(a.y, b.y);
    if (!(from < to) || to <= top || from >= bottom || std::min(a.x, b.x) >= right) continue;
    visit(from_tile(a), from_tile(b), k, sign);
  }
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
