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

#include "render/adaptive/quad-inl.h"
#include "render/adaptive/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

// A polygon's irradiance as what a row of pixels needs: a line along x, and how its level changes by row.
struct RowShade {
  QuadLine<double> line;
  DoubleQuad by_row;

  [[nodiscard]] HWY_INLINE QuadLine<double> at(int row) const {
    return {multiply_add(by_row, DoubleQuad::all(row), line.level), line.slope};
  }
  // What an edge between two polygons changes, seen from the first.
  friend HWY_INLINE RowShade operator-(const RowShade& a, const RowShade& b) {
    return {a.line - b.line, a.by_row - b.by_row};
  }
};

HWY_INLINE RowShade row_shade(const Shade& shade, const TileSums& tile) {
  const auto x = DoubleQuad::all(tile.x0 + 0.5 - static_cast<double>(shade.at.x));  // pixel centres
  const auto y = DoubleQuad::all(tile.y0 + 0.5 - static_cast<double>(shade.at.y));
  const auto along_x = to_doubles(shade.along_x.data()), along_y = to_doubles(shade.along_y.data());
  const auto level = multiply_add(along_x, x, multiply_add(along_y, y, to_doubles(shade.value.data())));
  return {{level, along_x}, along_y};
}

// What coverage is multiplied by: a polygon's irradiance row by row.
class EdgeShade {
 public:
  HWY_INLINE explicit EdgeShade(const RowShade& of, int row = 0) : of_(of), row_(of.at(row)) {}
  HWY_INLINE void set_row(int y) { row_ = of_.at(y); }
  // Adds `cover` of the row's irradiance to one column's sums.
  HWY_INLINE void add(double* to, double cover) const { add_times(QuadLine<double>::load(to), row_, cover).store(to); }

 private:
  RowShade of_;
  QuadLine<double> row_;
};

// One stretch of an edge within a row of pixels, from x0 to x1 and dy high: coverage to its right, as differences.
HWY_INLINE void add_stretch(TileSums& tile, int at_row, const EdgeShade& shade, double x0, double x1, double dy) {
  if (x0 > x1) std::swap(x0, x1);
  const auto first = static_cast<int>(x0);
  const auto last = static_cast<int>(x1);
  auto* const from = tile.at(at_row, first);
  tile.touch(at_row, first, last + 1);
  const auto column = [&](int k) { return from + TileSums::kLanes * static_cast<std::size_t>(k - first); };
  if (first == last) {
    const double right = dy * (0.5 * (x0 + x1) - first);
    shade.add(column(first), dy - right);
    shade.add(column(first + 1), right);
    return;
  }
  const double slope = dy / (x1 - x0);
  const double in_first = first + 1 - x0;
  double before = 0.5 * slope * in_first * in_first;
  double filled = slope * in_first;
  shade.add(column(first), before);
  for (int k = first + 1; k < last; ++k) {
    const double covered = filled + 0.5 * slope;
    shade.add(column(k), covered - before);
    before = covered;
    filled += slope;
  }
  const double in_last = x1 - last;
  const double covered = dy - 0.5 * slope * in_last * in_last;
  shade.add(column(last), covered - before);
  shade.add(column(last + 1), dy - covered);
}

// An edge inside the tile's columns, from a down to b, clipped to its rows: calls `visit` with each row, where the edge
// enters and leaves it and how high it is there.
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

// Where an edge gets no farther than a pixel to the side in a row: three columns, and nothing asked that depends on
// where it crosses from one to the next.
HWY_INLINE void add_steep_edge(TileSums& tile, EdgeShade shade, Vec2 a, Vec2 b, double sign) {
  const double dx = std::abs(b.x - a.x);
  const double half_dy_dx = dx != 0.0 ? 0.5 * sign * (b.y - a.y) / dx : 0.0;
  for_each_row(tile.height, a, b, [&](int row, double x, double x_next, double height) HWY_ATTR {
    const double dy = sign * height;
    const double left = std::min(x, x_next), right = std::max(x, x_next);
    const auto first = static_cast<int>(left), last = static_cast<int>(right);
    const double border = first + 1;
    const double over = std::max(right, border) - border;
    const double in_last = half_dy_dx * over * over;  // a triangle that the next column does not cover
    const double covered = dy * (border - 0.5 * (x + x_next)) + in_last;
    auto* const column = tile.at(row, first);
    shade.set_row(row);
    shade.add(column, covered);
    shade.add(column + TileSums::kLanes, dy - in_last - covered);
    shade.add(column + 2 * TileSums::kLanes, in_last);
    tile.touch(row, first, last + 1);
  });
}

HWY_INLINE void add_edge(TileSums& tile, EdgeShade shade, Vec2 a, Vec2 b, double sign) {
  if (std::abs(b.x - a.x) <= b.y - a.y) return add_steep_edge(tile, shade, a, b, sign);
  for_each_row(tile.height, a, b, [&](int row, double x, double x_next, double height) HWY_ATTR {
    shade.set_row(row);
    add_stretch(tile, row, shade, x, x_next, sign * height);
  });
}

// An edge that for_each_edge() visits. Parts left of the tile count as on its border, or not where sums are carried;
// parts to the right do not. Of coverage alone add_edge() is in tile_cover-inl.h.
template <class Sums, class AnyShade>
void add_clipped(Sums& tile, const AnyShade& shade, Vec2 a, Vec2 b, double sign) {
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
