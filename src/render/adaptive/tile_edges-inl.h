// A polygon's edges as changes of coverage, or of coverage times irradiance, along the rows of a tile.
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

#include "render/adaptive/tile_sums.h"

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

// What an edge between two polygons changes, seen from the first.
HWY_INLINE RowShade operator-(const RowShade& a, const RowShade& b) {
  RowShade out;
  for (std::size_t k = 0; k < TileSums::kLanes; ++k) {
    out.level[k] = a.level[k] - b.level[k];
    out.by_row[k] = a.by_row[k] - b.by_row[k];
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

// The same of coverage alone, inside the tile's columns, where the edge gets no farther than a pixel to the side in a
// row: three columns at the most, and nothing asked that depends on where it crosses from one to the next.
HWY_INLINE void add_steep_edge(CoverSums& tile, Vec2 a, Vec2 b, double sign) {
  const double dx_dy = (b.x - a.x) / (b.y - a.y);
  const double top = std::max(a.y, 0.0);
  const double bottom = std::min(b.y, static_cast<double>(tile.height));
  const double low = std::min(a.x, b.x);
  const double high = std::max(a.x, b.x);
  const double half_dy_dx = dx_dy != 0.0 ? 0.5 * sign / std::abs(dx_dy) : 0.0;
  double y = top;
  double x = std::clamp(a.x + dx_dy * (top - a.y), low, high);
  for (int row = static_cast<int>(top); y < bottom; ++row) {
    const double y_next = std::min<double>(row + 1, bottom);
    const double x_next = std::clamp(a.x + dx_dy * (y_next - a.y), low, high);
    const double dy = sign * (y_next - y);
    const auto first = static_cast<int>(std::min(x, x_next));
    const double border = first + 1;
    const double over = std::max(std::max(x, x_next) - border, 0.0);
    const double in_last = half_dy_dx * over * over;  // a triangle that the next column does not cover
    const double covered = dy * (border - 0.5 * (x + x_next)) + in_last;
    double* const column = tile.at(row, first);
    column[0] += covered;
    column[1] += dy - in_last - covered;
    column[2] += in_last;
    tile.touch(row, first, first + 1 + static_cast<int>(over > 0.0));
    x = x_next;
    y = y_next;
  }
}

// An edge inside the tile's columns, from a down to b, clipped to its rows.
template <class Sums>
HWY_INLINE void add_edge(Sums& tile, const RowShade& shade, Vec2 a, Vec2 b, double sign) {
  if constexpr (Sums::kLanes == 1)
    if (std::abs(b.x - a.x) <= b.y - a.y) return add_steep_edge(tile, a, b, sign);
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

// An edge that for_each_edge() visits. Parts left of the tile count as on its border, or not where sums are carried;
// parts to the right do not.
template <class Sums>
void add_clipped(Sums& tile, const RowShade& shade, Vec2 a, Vec2 b, double sign) {
  const double width = tile.width;
  if (a.y > b.y) {
    std::swap(a, b);
    sign = -sign;
  }
  const double low = std::min(a.x, b.x);
  const double high = std::max(a.x, b.x);
  if (low >= 0.0 && high < width) return add_edge(tile, shade, a, b, sign);
  if (high <= 0.0 && tile.is_carried()) return;
  if (high <= 0.0) return add_edge(tile, shade, {0.0, a.y}, {0.0, b.y}, sign);
  const auto at_x = [&](double x) {
    return Vec2{x, std::clamp(a.y + (x - a.x) * (b.y - a.y) / (b.x - a.x), a.y, b.y)};
  };
  const Vec2 left = low < 0.0 ? at_x(0.0) : (a.x < b.x ? a : b);
  const Vec2 right = high >= width ? at_x(width) : (a.x < b.x ? b : a);
  const Vec2 upper = left.y < right.y ? left : right;
  const Vec2 lower = left.y < right.y ? right : left;
  if (upper.y < lower.y) add_edge(tile, shade, upper, lower, sign);
  if (low >= 0.0 || tile.is_carried()) return;
  if (a.x < 0.0 && a.y < left.y) add_edge(tile, shade, {0.0, a.y}, {0.0, left.y}, sign);
  if (b.x < 0.0 && left.y < b.y) add_edge(tile, shade, {0.0, left.y}, {0.0, b.y}, sign);
}

// The polygon's edges that cross the tile's rows, left of its right border: their ends from the tile's corner, the
// first one's index among the polygon's, and the sign of what they bring.
template <class Visit>
HWY_INLINE void for_each_edge(const TileSums& tile, const PolygonList& list, const Polygon& polygon,
                              const Visit& visit) {
  const auto corners = list.corners_of(polygon);
  const auto from_tile = [&](Point p) {
    return Vec2{static_cast<double>(p.x) - tile.x0, static_cast<double>(p.y) - tile.y0};
  };
  const double sign = polygon.turns_left ? -1.0 : 1.0;  // y down in memory: left edges rise
  const auto top = static_cast<float>(tile.y0), bottom = static_cast<float>(tile.y0 + tile.height);
  const auto right = static_cast<float>(tile.x0 + tile.width);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point a = corners[k], b = corners[k + 1 == corners.size() ? 0 : k + 1];
    const float from = std::min(a.y, b.y), to = std::max(a.y, b.y);
    if (!(from < to) || to <= top || from >= bottom || std::min(a.x, b.x) >= right) continue;
    visit(from_tile(a), from_tile(b), k, sign);
  }
}

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
