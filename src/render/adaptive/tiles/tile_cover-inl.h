// SPDX-License-Identifier: Apache-2.0
// Adds the edges of a polygon to its coverage, stored as changes along the rows of a tile: several rows of an edge, or
// several columns of a row, at once.
#if defined(CONTREJOUR_ADAPTIVE_TILE_COVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_COVER_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_COVER_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_COVER_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/adaptive/tiles/tile_edges-inl.h"
#include "render/adaptive/tiles/tile_rows-inl.h"
#include "render/adaptive/tiles/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

// Marks sums of coverage alone, which is not multiplied by an irradiance.
struct NoIrradiance {};

// For an edge inside the tile's columns, from a down to b, clipped to its rows: calls `visit` with each row, the points
// at which the edge enters and leaves it, and the edge's height there.
template <class Visit>
HWY_INLINE void for_each_row(int height, Vec2 a, Vec2 b, const Visit& visit) {
  const double dx_dy = (b.x - a.x) / (b.y - a.y);
  const double top = std::max(a.y, 0.0);
  const double bottom = std::min(b.y, static_cast<double>(height));
  const double low = std::min(a.x, b.x);
  const double high = std::max(a.x, b.x);
  double y = top;
  double x = std::clamp(a.x + dx_dy * (top - a.y), low, high);
  for (int row = static_cast<int>(top); y < bottom; ++row) {
    const double y_next = std::min<double>(row + 1, bottom);
    const double x_next = std::clamp(a.x + dx_dy * (y_next - a.y), low, high);
    visit(row, x, x_next, y_next - y);
    x = x_next;
    y = y_next;
  }
}

// Adds an edge that moves no more than a pixel to the side in a row, thus over three columns at most, without branches
// on where it crosses from one to the next. x is relative to the column in which the edge is farthest left, rows to the
// first one, so that floats are accurate enough.
HWY_INLINE void add_steep_cover(CoverageSums& tile, Vec2 a, Vec2 b, double sign) {
  const FloatTag d;
  const IntTag di;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
  const double top = std::max(a.y, 0.0), bottom = std::min(b.y, static_cast<double>(tile.height));
  if (!(top < bottom)) return;
  const auto first_row = static_cast<int>(top), rows = static_cast<int>(std::ceil(bottom)) - first_row;
  const auto first_column = static_cast<int>(std::min(a.x, b.x));
  const double dx_dy = (b.x - a.x) / (b.y - a.y);
  const double dx = std::abs(b.x - a.x);
  const auto all = [&](double v) { return hn::Set(d, static_cast<float>(v)); };
  const auto low = all(std::min(a.x, b.x) - first_column), high = all(std::max(a.x, b.x) - first_column);
  const auto slope = all(dx_dy), at_zero = all(a.x - first_column - dx_dy * (a.y - first_row));
  const auto half_dy_dx = all(dx != 0.0 ? 0.5 * sign * (b.y - a.y) / dx : 0.0);
  const auto from = all(top - first_row), to = all(bottom - first_row), one = hn::Set(d, 1.0F);
  const auto x_at = [&](hn::Vec<FloatTag> y)
                        HWY_ATTR { return hn::Min(hn::Max(hn::MulAdd(slope, y, at_zero), low), high); };
  CoverageSums::Changed& changed = tile.changed_by(sign);
  for (int k = 0; k < rows; k += kLanes) {
    const auto row = hn::Iota(d, static_cast<float>(k));
    const auto y0 = hn::Max(row, from), y1 = hn::Min(hn::Add(row, one), to);
    const auto x0 = x_at(y0), x1 = x_at(y1);
    const auto dy = hn::Mul(all(sign), hn::Sub(y1, y0));
    const auto first = hn::Floor(hn::Min(x0, x1)), right = hn::Max(x0, x1), border = hn::Add(first, one);
    const auto over = hn::Max(hn::Sub(right, border), hn::Zero(d));
    const auto in_last = hn::Mul(half_dy_dx, hn::Mul(over, over));  // a triangle that the next column does not cover
    const auto middle = hn::Mul(hn::Set(d, 0.5F), hn::Add(x0, x1));
    const auto covered = hn::MulAdd(dy, hn::Sub(border, middle), in_last);

    HWY_ALIGN float change[3][kLanes];
    HWY_ALIGN std::int32_t column[kLanes];
    const auto base = hn::Set(di, first_column);
    const auto whole = hn::Add(hn::ConvertTo(di, first), base);
    hn::Store(whole, di, column);
    hn::Store(covered, d, change[0]);
    hn::Store(hn::Sub(hn::Sub(dy, in_last), covered), d, change[1]);
    hn::Store(in_last, d, change[2]);
    const int count = std::min(kLanes, rows - k);
    for (int j = 0; j < count; ++j) {
      float* const at = tile.at(first_row + k + j, column[j]);
      for (int c = 0; c < 3; ++c) at[c] += change[c][j];
    }
    const auto last = hn::Add(hn::ConvertTo(di, hn::Floor(right)), hn::Add(base, hn::Set(di, 1)));
    const auto used = hn::Lt(hn::Iota(di, 0), hn::Set(di, count));
    std::int32_t *const firsts = changed.firsts(first_row + k), *const lasts = changed.lasts(first_row + k);
    const auto old_first = hn::LoadU(di, firsts), old_last = hn::LoadU(di, lasts);
    hn::StoreU(hn::IfThenElse(used, hn::Min(old_first, whole), old_first), di, firsts);
    hn::StoreU(hn::IfThenElse(used, hn::Max(old_last, last), old_last), di, lasts);
  }
}

// Adds a segment of an edge within a row. Coverage increases over the columns from `left` to `right` and is dy beyond;
// each sum receives what the segment covers of its column minus what it covers of the column before. half_slope: half
// of the increase of coverage over a column.
HWY_INLINE void add_flat_cover(CoverageSums& tile, int row, double left, double right, double dy, double half_slope) {
  const FloatTag d;
  const auto first = static_cast<int>(left), last = static_cast<int>(right);
  tile.changed_by(dy).add(row, first, last + 1);
  float* const to = tile.at(row, first);
  const auto all = [&](double v) { return hn::Set(d, static_cast<float>(v)); };
  const auto from = all(left - first), width = all(right - left), one = hn::Set(d, 1.0F), none = hn::Zero(d);
  const auto high = all(dy), half = all(half_slope), end = all(last + 1 - first);
  const auto within = [&](hn::Vec<FloatTag> u) HWY_ATTR { return hn::Min(hn::Max(u, none), width); };
  const auto beyond = [&](hn::Vec<FloatTag> u) HWY_ATTR { return hn::Min(hn::Max(hn::Sub(u, width), none), one); };
  for (int k = 0; k <= last + 1 - first; k += static_cast<int>(hn::Lanes(d))) {
    const auto u =
        hn::Sub(hn::Iota(d, static_cast<float>(k)), from);  // from the segment's beginning to the column's left border
    const auto next = hn::Add(u, one);
    const auto before = within(hn::Sub(u, one)), here = within(u), after = within(next);
    const auto square = hn::Sub(hn::Mul(hn::Sub(after, here), hn::Add(after, here)),
                                hn::Mul(hn::Sub(here, before), hn::Add(here, before)));
    const auto change = hn::MulAdd(half, square, hn::Mul(high, hn::Sub(beyond(next), beyond(u))));
    const auto used = hn::Le(hn::Iota(d, static_cast<float>(k)), end);  // beyond the end there is only rounding
    hn::StoreU(hn::Add(hn::LoadU(d, to + k), hn::IfThenElseZero(used, change)), d, to + k);
  }
}

HWY_INLINE void add_edge(CoverageSums& tile, NoIrradiance /*none*/, Vec2 a, Vec2 b, double sign) {
  const double dx = std::abs(b.x - a.x), dy = b.y - a.y;
  if (dx <= dy) return add_steep_cover(tile, a, b, sign);
  const double half_slope = 0.5 * sign * dy / dx;
  for_each_row(tile.height, a, b, [&](int row, double x, double x_next, double height) HWY_ATTR {
    add_flat_cover(tile, row, std::min(x, x_next), std::max(x, x_next), sign * height, half_slope);
  });
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
