// Polygons behind a screen: their coverage first, then pixel by pixel the light that passes.
#if defined(CONTREJOUR_ADAPTIVE_TILE_SCREENS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_SCREENS_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_SCREENS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_SCREENS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "render/adaptive/quad-inl.h"
#include "render/adaptive/tile_edges-inl.h"
#include "render/adaptive/tile_fringes-inl.h"
#include "render/adaptive/tile_patterns-inl.h"
#include "render/adaptive/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

static_assert(TileSums::kPixel == 4);

// What passes any screen, several crossings of the stop among them, and dirt. Either may be null.
class AnyScreen {
 public:
  static constexpr bool kGrey = false;
  AnyScreen(const BandScreen* screen, const StopMap& map, const PastDirt* dirt = nullptr)
      : screen_(screen), map_(map), dirt_(dirt) {}

  void look(const PixelRow& row) { row_ = &row; }
  [[nodiscard]] static Seen seen(int /*group*/) { return Seen::Varied; }
  [[nodiscard]] Quad passed(int k) const {
    std::array<StopPlace, kMaxStopCrossings> room;
    std::array<double, 3> share{1.0, 1.0, 1.0};
    if (screen_ != nullptr) share = screen_->share(map_.places(row_->pixel(k), room));
    const float all[] = {static_cast<float>(share[0]), static_cast<float>(share[1]), static_cast<float>(share[2]),
                         0.0F};
    if (dirt_ == nullptr) return Quad::load(all);
    return Quad::load(all) * Quad::all(static_cast<float>(dirt_->passed(row_->pixel(k))));
  }

 private:
  const BandScreen* screen_;
  const StopMap& map_;
  const PastDirt* dirt_;
  const PixelRow* row_ = nullptr;
};

// A row's coverage from its changes, which are cleared. Pixels that only rounding covers are not. Most pixels have no
// changes: some of them at once take one test. Writes whole vectors.
HWY_INLINE void sum_coverage(double* changes, int count, float* cover) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  constexpr auto kMost = hn::MaxLanes(hn::ScalableTag<double>());
  const auto lanes = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN double from_lane[2 * kMost] = {};  // 1 from `lanes` on: read from k before there, 1 in lanes k and up
  std::fill_n(from_lane + lanes, lanes, 1.0);
  auto covered = hn::Zero(d);
  auto seen = hn::Zero(df);
  for (int k = 0; k < count; k += lanes) {
    const auto change = hn::LoadU(d, changes + k);
    if (hn::AllTrue(d, hn::Eq(change, hn::Zero(d)))) {
      hn::StoreU(seen, df, cover + k);
      continue;
    }
    auto sum = covered;
    for (int j = 0; j < lanes; ++j)
      sum = hn::MulAdd(hn::Set(d, changes[k + j]), hn::LoadU(d, from_lane + lanes - j), sum);
    covered = hn::Add(covered, hn::SumOfLanes(d, change));
    hn::StoreU(hn::Zero(d), d, changes + k);
    const auto shown = [&](auto v) HWY_ATTR {
      return hn::DemoteTo(df, hn::IfThenElseZero(hn::Gt(v, hn::Set(d, TileSums::kUnseenCover)), v));
    };
    hn::StoreU(shown(sum), df, cover + k);
    seen = shown(covered);
  }
  changes[count] = 0.0;
}

// Whole pixels in a row that see the stop level: their light is left as changes along the row, as any polygon's is.
class LevelRun {
 public:
  LevelRun(TileSums& tile, int row, const RowShade& shade) : tile_(tile), row_(row), shade_(shade) {}

  void go_on(int first, int end) {
    if (first_ < 0) first_ = first;
    end_ = end;
  }
  void stop() {
    if (first_ < 0) return;
    HWY_ALIGN double at_row[TileSums::kLanes];
    for (std::size_t k = 0; k < TileSums::kLanes; ++k) at_row[k] = shade_.level[k] + shade_.by_row[k] * row_;
    tile_.touch(row_, first_, end_);
    add<TileSums>(tile_.at(row_, first_), at_row, 1.0);
    add<TileSums>(tile_.at(row_, end_), at_row, -1.0);
    first_ = -1;
  }

 private:
  TileSums& tile_;
  int row_;
  const RowShade& shade_;
  int first_ = -1, end_ = -1;
};

// A polygon's irradiance times what passes, pixel by pixel.
class QuadLight {
 public:
  explicit QuadLight(const RowShade& shade)
      : level_(quad(shade.level)), slope_(quad(shade.level + TileSums::kPixel)), by_row_(quad(shade.by_row)),
        in_row_(level_) {}
  void set_row(int row) { in_row_ = multiply_add(by_row_, Quad::all(static_cast<float>(row)), level_); }

  // Adds pixels k to `end` of a row to `to`, which is pixel k; `column` is its column.
  template <class Look>
  HWY_INLINE void add(const Look& look, const float* cover, int k, int end, int column, float* to) const {
    for (; k < end; ++k, ++column, to += TileSums::kPixel) {
      const Quad irradiance = multiply_add(slope_, Quad::all(static_cast<float>(column)), in_row_);
      multiply_add(Quad::all(cover[k]) * irradiance, look.passed(k), Quad::load(to)).store(to);
    }
  }

 private:
  static Quad quad(const double* from) {
    float v[TileSums::kPixel];
    for (std::size_t c = 0; c < TileSums::kPixel; ++c) v[c] = static_cast<float>(from[c]);
    return Quad::load(v);
  }
  Quad level_, slope_, by_row_, in_row_;
};

// The same where one value serves all channels: whole vectors of pixels at once, which have nothing beyond the row.
class GreyLight {
 public:
  explicit GreyLight(const RowShade& shade) {
    const auto repeat = [](const double* from, float* to) {
      for (std::size_t k = 0; k < kLanes; ++k) to[k] = static_cast<float>(from[k % TileSums::kPixel]);
    };
    repeat(shade.level, level_);
    repeat(shade.level + TileSums::kPixel, slope_);
    repeat(shade.by_row, by_row_);
  }
  void set_row(int row) {
    for (std::size_t k = 0; k < kLanes; ++k) in_row_[k] = level_[k] + by_row_[k] * static_cast<float>(row);
  }

  template <class Look>
  HWY_INLINE void add(const Look& look, const float* cover, int k, int /*end*/, int column, float* to) const {
    add(hn::Mul(hn::Load(FloatTag(), cover + k), look.passed(k)), column, to);
  }

 private:
  HWY_INLINE void add(hn::Vec<FloatTag> passed, int column, float* to) const {
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t c = 0; c < TileSums::kPixel; ++c)
      to[c] += hn::GetLane(passed) * (in_row_[c] + slope_[c] * static_cast<float>(column));
#else
    const FloatTag d;
    const IntTag di;
    const std::size_t lanes = hn::Lanes(d), pixels = lanes / TileSums::kPixel;
    const auto slope = hn::Load(d, slope_);
    // Lane k of a vector is of its pixel k / 4.
    auto pixel = hn::ShiftRight<2>(hn::Iota(di, 0));
    const auto next = hn::Set(di, static_cast<std::int32_t>(pixels));
    auto irradiance = hn::MulAdd(slope, hn::Add(hn::Set(d, static_cast<float>(column)), hn::ConvertTo(d, pixel)),
                                 hn::Load(d, in_row_));
    const auto further = hn::Mul(slope, hn::Set(d, static_cast<float>(pixels)));
    for (std::size_t part = 0; part < TileSums::kPixel; ++part, to += lanes) {
      const auto each = hn::TableLookupLanes(passed, hn::IndicesFromVec(d, pixel));
      hn::StoreU(hn::MulAdd(each, irradiance, hn::LoadU(d, to)), d, to);
      pixel = hn::Add(pixel, next);
      irradiance = hn::Add(irradiance, further);
    }
#endif
  }

  static constexpr std::size_t kLanes = std::max<std::size_t>(hn::MaxLanes(FloatTag()), TileSums::kPixel);
  HWY_ALIGN float level_[kLanes], slope_[kLanes], by_row_[kLanes], in_row_[kLanes];
};

// Whether pixels are all covered, but for rounding.
HWY_INLINE bool all_covered(const float* cover, int count) {
  constexpr float kWhole = 1.0F - 1e-6F;
  const FloatTag d;
  if (count == static_cast<int>(hn::Lanes(d))) return hn::AllTrue(d, hn::Ge(hn::Load(d, cover), hn::Set(d, kWhole)));
  for (int k = 0; k < count; ++k)
    if (cover[k] < kWhole) return false;
  return true;
}

// Of a tile, those that a polygon may touch. last_column: as far as all of them are covered at the least; -1: not told.
struct PixelRows {
  int first, last, last_column;
};

PixelRows rows_under(const TileSums& tile, std::span<const Point> corners) {
  Point low = corners[0], high = corners[0];
  for (const Point p : corners) {
    low.y = std::min(low.y, p.y);
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto row = [&](float y) {
    return static_cast<int>(std::clamp(y - static_cast<float>(tile.y0), 0.0F, static_cast<float>(tile.height - 1)));
  };
  // Edges beyond the right border leave no change: what is covered there ends with the tile.
  return {row(low.y), row(high.y), high.x > static_cast<float>(tile.x0 + tile.width) ? tile.width - 1 : -1};
}

// A row of what a polygon covers.
struct CoveredRow {
  int row, first, count;  // in the tile
  const float* cover;  // none beyond `count`, a vector long
};

// All of a polygon's rows, before the first of them is looked at: what was just written one by one cannot yet be read
// by whole vectors.
class Coverage {
 public:
  Coverage(TileSums& tile, const PixelRows& within) {
    const FloatTag d;
    std::size_t room = 0;
    for (int row = within.first; row <= within.last; ++row) {
      const auto changed = std::exchange(tile.cover.changed[static_cast<std::size_t>(row)], {});
      const int last = std::min(std::max(changed.last, within.last_column), tile.width - 1);
      if (changed.first > last) {
        if (changed.last >= 0) *tile.cover.at(row, tile.width) = 0.0;  // the right border's
        continue;
      }
      const int count = last - changed.first + 1;
      sum_coverage(tile.cover.at(row, changed.first), count, cover_ + room);
      hn::StoreU(hn::Zero(d), d, cover_ + room + count);
      rows_[count_++] = {row, changed.first, count, cover_ + room};
      room += hwy::RoundUpTo(static_cast<std::size_t>(count), hn::Lanes(d));
    }
  }
  [[nodiscard]] std::span<const CoveredRow> rows() const { return {rows_, count_}; }

 private:
  HWY_ALIGN float cover_[kRowRoom * TileGrid::kHeight];
  CoveredRow rows_[TileGrid::kHeight];
  std::size_t count_ = 0;
};

// A row's pixels, as `look` finds them.
template <class Look, class Light>
HWY_INLINE void add_row(TileSums& tile, const CoveredRow& r, const RowShade& shade, const Look& look,
                        const Light& light) {
  const int lanes = static_cast<int>(hn::Lanes(FloatTag()));
  float* const to = tile.pixels_at(r.row) + TileSums::kPixel * static_cast<std::size_t>(r.first);
  LevelRun run(tile, r.row, shade);
  for (int k = 0; k < r.count; k += lanes) {
    const Seen seen = look.seen(k / lanes);
    const int end = std::min(k + lanes, r.count);
    if (seen == Seen::Level && all_covered(r.cover + k, end - k)) {
      run.go_on(r.first + k, r.first + end);
      continue;
    }
    run.stop();
    if (seen == Seen::Dark) continue;
    tile.light(r.row, r.first + k, r.first + end - 1);
    light.add(look, r.cover, k, end, r.first + k, to + TileSums::kPixel * static_cast<std::size_t>(k));
  }
  run.stop();
}

template <class Look>
void add_pixels(TileSums& tile, const Polygon& polygon, const StopMap& map, const PixelRows& within, Look& look) {
  const Coverage coverage(tile, within);
  const auto rows = coverage.rows();
  std::array<StopMap::Row, TileGrid::kHeight> stop;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    stop[k] = map.row(tile.y0 + rows[k].row + 0.5);
    const auto first = static_cast<float>(tile.x0 + rows[k].first + 0.5 - map.origin().x);
    if constexpr (requires { look.fetch(stop[k], first, first); })
      look.fetch(stop[k], first, first + static_cast<float>(rows[k].count - 1));
  }
  const RowShade shade = row_shade(polygon.shade, tile);
  std::conditional_t<Look::kGrey, GreyLight, QuadLight> light(shade);
  PixelRow pixels;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    pixels.first = tile.x0 + rows[k].first;
    pixels.y = tile.y0 + rows[k].row;
    pixels.count = rows[k].count;
    pixels.look_at_stop(stop[k], map.origin().x);
    look.look(pixels);
    light.set_row(rows[k].row);
    add_row(tile, rows[k], shade, look, light);
  }
}

void add_screened(TileSums& tile, const PolygonList& list, const Polygon& polygon) {
  if (tile.by_pixel.empty())
    tile.by_pixel.resize(TileSums::kPixel * (TileGrid::kWidth * TileGrid::kHeight + hn::MaxLanes(FloatTag())), 0.0F);
  CoverSums& cover = tile.cover;
  cover.width = tile.width;
  cover.height = tile.height;
  cover.make();
  const auto corners = list.corners_of(polygon);
  for_each_edge(tile, list, polygon,
                [&](Vec2 a, Vec2 b, std::size_t, double sign) { add_clipped(cover, RowShade{}, a, b, sign); });
  const PixelRows within = rows_under(tile, corners);
  const Screened& behind = list.screened[polygon.screened - 1];
  const auto add = [&](auto&& look) { add_pixels(tile, polygon, behind.map, within, look); };
  if (behind.dirt != 0) return add(AnyScreen(behind.screen, behind.map, &list.dirt[behind.dirt - 1]));
  if (behind.edges != nullptr) {
    const IrisShape& iris = behind.edges->iris();
    const std::span<const std::uint16_t> active(list.bounds.data() + behind.first, behind.count);
    if (behind.edges->is_grey()) return add(GreyFringes(*behind.edges, active));
    if (active.size() == 1 && !iris.is_picture()) return add(Fringe(*behind.edges, iris.bounds()[active[0]]));
    return add(Fringes(*behind.edges, active));
  }
  if (behind.screen->pattern && behind.map.crossings() == 1) {
    const screens::BandPattern& pattern = *behind.screen->pattern;
    if (!pattern.of_one()) return add(Pattern(*behind.screen, behind.map.width()));
    if (behind.screen->is_grey()) return add(GreyPattern(pattern, behind.map.width()));
  }
  add(AnyScreen(behind.screen, behind.map));
}

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
