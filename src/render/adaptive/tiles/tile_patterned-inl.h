// SPDX-License-Identifier: Apache-2.0
// Draws polygons behind a stop pattern: first their coverage, then for each pixel the transmitted light.
#if defined(CONTREJOUR_ADAPTIVE_TILE_PATTERNED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_PATTERNED_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_PATTERNED_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_PATTERNED_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "render/adaptive/tiles/channel_vector-inl.h"
#include "render/adaptive/tiles/pixels-inl.h"
#include "render/adaptive/tiles/tile_cover-inl.h"
#include "render/adaptive/tiles/tile_edges-inl.h"
#include "render/adaptive/tiles/tile_fringes-inl.h"
#include "render/adaptive/tiles/tile_rows-inl.h"
#include "render/adaptive/tiles/tile_textures-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

// A transmittance for each pixel, from a polygon's own table.
class PixelTable {
 public:
  static constexpr bool kMonochrome = false;
  PixelTable(const PolygonList& list, const Pattern& pattern)
      : spans_(list.spans.data() + pattern.first, pattern.count), pixels_(list.pixels.data()) {}

  void set_row(const PixelRow& row) {
    const auto at = static_cast<std::size_t>(spans_.empty() ? 0 : row.y - spans_.front().y);
    const PixelSpan span = at < spans_.size() ? spans_[at] : PixelSpan{};
    values_ = pixels_ + span.first;
    count_ = span.count;
    skipped_ = row.first - span.x;
  }
  [[nodiscard]] const PixelTable& lookup(const PixelRow& /*row*/, Groups /*wanted*/) const { return *this; }
  [[nodiscard]] const PixelTable& vector(int /*k*/) const { return *this; }
  // Nothing of the polygon lies in pixels that the table lacks.
  [[nodiscard]] ChannelVector transmitted(int k) const {
    const auto at = static_cast<std::size_t>(skipped_ + k);
    if (at >= count_) return ChannelVector::all(0.0F);
    const std::array<float, 3>& value = values_[at];
    const float all[] = {value[0], value[1], value[2], 0.0F};
    return ChannelVector::load(all);
  }

 private:
  std::span<const PixelSpan> spans_;
  const std::array<float, 3>* pixels_;
  const std::array<float, 3>* values_ = nullptr;
  std::size_t count_ = 0;
  int skipped_ = 0;
};

// The mean of look-ups at the middles of `across` x `across` parts of each pixel.
template <class Lookup>
class MeanOfSamples {
 public:
  static constexpr bool kMonochrome = Lookup::kMonochrome;
  MeanOfSamples(Lookup& lookup, int across) : lookup_(lookup), across_(across) {}

  void set_row(const PixelRow& /*row*/) const {}
  HWY_INLINE const MeanOfSamples& lookup(const PixelRow& row, Groups wanted) {
    std::fill_n(sum_, kNumbers * static_cast<std::size_t>(row.count + kLanes), 0.0F);
    const auto middle = [&](int part) { return (part + 0.5) / across_ - 0.5; };
    for (int part = 0; part < across_ * across_; ++part) {
      const PixelRow moved = row.moved({middle(part % across_), middle(part / across_)});
      if constexpr (requires { lookup_.expect_row(moved); }) lookup_.expect_row(moved);
      lookup_.set_row(moved);
      add(lookup_.lookup(moved, wanted), row.count);
    }
    return *this;
  }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> transmitted(int k) const
    requires kMonochrome
  {
    return hn::LoadU(FloatTag(), sum_ + k);
  }
  [[nodiscard]] const MeanOfSamples& vector(int /*k*/) const { return *this; }
  [[nodiscard]] HWY_INLINE ChannelVector transmitted(int k) const
    requires(!kMonochrome)
  {
    return ChannelVector::load(sum_ + kVectorChannels * static_cast<std::size_t>(k));
  }

 private:
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
  static constexpr std::size_t kNumbers = kMonochrome ? 1 : kVectorChannels;  // for a pixel

  template <class Row>
  HWY_INLINE void add(const Row& one, int count) {
    const float weight = 1.0F / static_cast<float>(across_ * across_);
    for (int k = 0; k < count; k += kLanes) {
      if constexpr (kMonochrome) {
        const FloatTag d;
        hn::StoreU(hn::MulAdd(one.transmitted(k), hn::Set(d, weight), hn::LoadU(d, sum_ + k)), d, sum_ + k);
      } else {
        const auto& values = one.vector(k);
        for (int j = k; j < std::min(k + kLanes, count); ++j) {
          float* const to = sum_ + kVectorChannels * static_cast<std::size_t>(j);
          multiply_add(values.transmitted(j), ChannelVector::all(weight), ChannelVector::load(to)).store(to);
        }
      }
    }
  }

  Lookup& lookup_;
  int across_;
  HWY_ALIGN float sum_[kNumbers * (kRowCapacity + static_cast<std::size_t>(kLanes))];
};

// A row's coverage from its changes, which are cleared, some pixels after another. Coverage below rounding errors is
// zero.
class RunningCover {
 public:
  // count: no more pixels of the row are covered, whatever its changes say.
  HWY_INLINE RunningCover(float* changes, int count)
      : changes_(changes), count_(count), before_(hn::Zero(FloatTag())) {}

  // The coverage of the pixels from k on, by prefix sums over two, four and eight neighbours.
  HWY_INLINE hn::Vec<FloatTag> next(int k) {
    constexpr std::size_t kLanes = hn::MaxLanes(FloatTag());
    const FloatTag d;
    auto sum = hn::LoadU(d, changes_ + k);
    hn::StoreU(hn::Zero(d), d, changes_ + k);
    for (std::size_t step = 1; step < kLanes; step *= 2) {
      HWY_ALIGN std::int32_t from[kLanes];
      HWY_ALIGN float has[kLanes];
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        from[lane] = static_cast<std::int32_t>(lane < step ? 0 : lane - step);
        has[lane] = lane < step ? 0.0F : 1.0F;
      }
      sum = hn::MulAdd(hn::Load(d, has), hn::TableLookupLanes(sum, hn::SetTableIndices(d, from)), sum);
    }
    sum = hn::Add(sum, before_);
    before_ = hn::TableLookupLanes(sum, hn::IndicesFromVec(d, hn::Set(IntTag(), kLanes - 1)));
    const auto cover = hn::IfThenElseZero(hn::Gt(sum, hn::Set(d, TileSums::kNegligibleCoverage)), sum);
    const int left = count_ - k;
    if (left >= static_cast<int>(kLanes)) return cover;
    return hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(std::max(left, 0))), cover);
  }
  // Returns whether the pixel before the next one is fully covered.
  [[nodiscard]] HWY_INLINE bool is_whole() const {
    constexpr float kWhole = 1.0F - 1e-5F;  // for rounding
    return hn::GetLane(before_) >= kWhole;
  }

 private:
  float* changes_;
  int count_;
  hn::Vec<FloatTag> before_;  // sum of all changes before
};

// Adds fully covered pixels of a row where the pattern transmits all light: as changes along the row, like any
// polygon's.
HWY_INLINE void add_level(TileSums& tile, int row, int first, int end, const RowIrradiance& irradiance) {
  const ChannelLine<double> line = irradiance.at(row);
  add_step(tile, row, first, line, 1.0);
  add_step(tile, row, end, line, -1.0);
}

// A row of a polygon's coverage in the tile. It starts at a multiple of kFirst columns, where cache lines begin.
constexpr int kFirst = 4;
struct CoveredRow {
  int row, first, count;
  int even_first, even_end;  // columns of the tile between which coverage is constant, if any
};

// A polygon's irradiance times the transmittance, for some pixels at once; beyond the row there is nothing.
template <bool kMonochrome>  // one value serves all channels
class PixelLight {
  using Pixels = PixelsOf<float>;

 public:
  explicit PixelLight(const RowIrradiance& irradiance)
      : line_(ChannelLine<float>{to_floats(irradiance.line.level), to_floats(irradiance.line.slope)}),
        by_row_(Pixels::each(to_floats(irradiance.by_row))) {}

  class Row {
   public:
    HWY_INLINE Row(const PixelLight& all, const CoveredRow& row)
        : light_(all.line_.raised(all.by_row_, row.row).from(row.first)), count_(row.count) {}
    // Adds the covered parts of the pixels from k on to the row at `to`.
    template <class Lookup>
    HWY_INLINE void add(const Lookup& lookup, hn::Vec<FloatTag> cover, int k, float* to) const {
      if constexpr (kMonochrome) {
        add_level(hn::Mul(cover, lookup.transmitted(k)), k, to);
      } else {
        const auto& values = lookup.vector(k);
        HWY_ALIGN float transmitted[kChannels * Pixels::kLanes + 1] = {};
        for (int j = 0; j < std::min(Pixels::kCount, count_ - k); ++j)
          values.transmitted(k + j).store(transmitted + kChannels * static_cast<std::size_t>(j));
        add_weighted(Pixels::of(cover) * Pixels::load(transmitted), k, to);
      }
    }
    // Adds pixels that transmit all light.
    HWY_INLINE void add_level(hn::Vec<FloatTag> cover, int k, float* to) const {
      add_weighted(Pixels::of(cover), k, to);
    }

   private:
    HWY_INLINE void add_weighted(const Pixels& weights, int k, float* to) const {
      float* const at = to + kChannels * static_cast<std::size_t>(k);
      multiply_add(weights, light_.at(k), Pixels::load(at)).store(at);
    }
    PixelLine<float> light_;
    int count_;
  };

 private:
  PixelLine<float> line_;  // of the tile's first row
  Pixels by_row_;
};

// The rows of a tile that a polygon may touch, and the columns between which it lies. covered_to: the column up to
// which all rows are covered at least; -1: unknown.
struct PixelRows {
  int first, last;
  int low_column, high_column;
  int covered_to;
};

PixelRows rows_under(const TileSums& tile, std::span<const Point> corners) {
  Point low = corners[0], high = corners[0];
  for (const Point p : corners) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto row = [&](float y) {
    return static_cast<int>(std::clamp(y - static_cast<float>(tile.y0), 0.0F, static_cast<float>(tile.height - 1)));
  };
  const auto column = [&](float x) {
    return static_cast<int>(std::clamp(x - static_cast<float>(tile.x0), 0.0F, static_cast<float>(tile.width)));
  };
  // Edges beyond the right border, or on it, leave no change: coverage then extends to the end of the tile.
  const bool is_beyond = high.x >= static_cast<float>(tile.x0 + tile.width);
  return {row(low.y), row(high.y), column(low.x), column(high.x), is_beyond ? tile.width - 1 : -1};
}

// The rows in which a polygon's edges have left changes.
class CoveredRows {
 public:
  CoveredRows(TileSums& tile, const PixelRows& within) {
    for (int row = within.first; row <= within.last; ++row) {
      const auto begun = tile.cover.begun.take(row), ended = tile.cover.ended.take(row);
      const int changed_first = std::min(begun.first, ended.first), changed_last = std::max(begun.last, ended.last);
      const int last = std::min(std::max(changed_last, within.covered_to), tile.width - 1);
      if (changed_last >= tile.width) std::fill_n(tile.cover.at(row, tile.width), 2, 0.0F);  // at the right border
      const int first = changed_first / kFirst * kFirst;
      const int even_first = begun.last < 0 ? tile.width : begun.last + 1, even_end = std::min(ended.first, tile.width);
      if (changed_first <= last) rows_[count_++] = {row, first, last - first + 1, even_first, even_end};
    }
  }
  [[nodiscard]] std::span<const CoveredRow> all() const { return {rows_, count_}; }

 private:
  CoveredRow rows_[TileGrid::kHeight];
  std::size_t count_ = 0;
};

// A row to be drawn. Coverage ends with the last change, except at the tile's border, beyond which changes are not
// stored.
struct RowOfPixels {
  CoveredRow columns;
  RunningCover cover;
  float* to;

  RowOfPixels(TileSums& tile, const CoveredRow& r)
      : columns(r), cover(tile.cover.at(r.row, r.first), r.first + r.count < tile.width ? kRowCapacity : r.count),
        to(tile.light_at(r.row) + TileSums::kPixel * static_cast<std::size_t>(r.first)) {}
};

template <class Transmitted, class LightRow>
HWY_INLINE void add_row(TileSums& tile, RowOfPixels row, const Transmitted& transmitted, const LightRow& light) {
  const int count = row.columns.count;
  for (int k = 0; k < count; k += static_cast<int>(hn::MaxLanes(FloatTag())))
    light.add(transmitted, row.cover.next(k), k, row.to);
  tile.light_groups(row.columns.row, row.columns.first, first_groups((count + kGroup - 1) / kGroup));
}

// Draws a row without look-ups for groups in which the pattern is dark or transmits all light. Where such groups are
// fully covered and no edge changes that, coverage is not summed either, and their light is added as steps.
template <class Transmitted, class LightRow>
HWY_INLINE void add_row(TileSums& tile, RowOfPixels row, const RowIrradiance& irradiance, const UniformGroups& uniform,
                        const Transmitted& transmitted, const LightRow& light) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
  const CoveredRow& columns = row.columns;
  const int groups = (columns.count + kGroup - 1) / kGroup;
  const int even_first = (columns.even_first - columns.first + kGroup - 1) / kGroup;
  const int even_end = (columns.even_end - columns.first) / kGroup;
  Groups skipped = 0, lit = 0;
  if (even_first < even_end)
    skipped = (uniform.dark | uniform.level) & first_groups(even_end) & ~first_groups(even_first);
  for (int group = 0; group < groups;) {
    if ((skipped >> static_cast<unsigned>(group) & 1U) != 0) {
      if (row.cover.is_whole()) {
        group += std::countr_one(skipped >> static_cast<unsigned>(group));
        continue;
      }
      skipped = 0;
    }
    const Groups bit = Groups{1} << static_cast<unsigned>(group);
    const bool is_dark = (uniform.dark & bit) != 0, is_level = (uniform.level & bit) != 0;
    if (!is_dark) lit |= bit;
    for (int k = kGroup * group; k < kGroup * (group + 1); k += kLanes) {
      const auto cover = row.cover.next(k);
      if (is_level)
        light.add_level(cover, k, row.to);
      else if (!is_dark)
        light.add(transmitted, cover, k, row.to);
    }
    ++group;
  }
  for (Groups level = skipped & uniform.level; level != 0;) {
    const int from = std::countr_zero(level), end = from + std::countr_one(level >> static_cast<unsigned>(from));
    add_level(tile, columns.row, columns.first + kGroup * from, columns.first + kGroup * end, irradiance);
    level &= ~first_groups(end);
  }
  tile.light_groups(columns.row, columns.first, lit);
}

template <class Lookup>
void add_pixels(TileSums& tile, const LinearIrradiance& of, const PatternMap& map, const PixelRows& within,
                Lookup& lookup) {
  constexpr int kShort = 4 * kGroup;  // pixels: in shorter rows, testing groups costs more than it saves
  const CoveredRows rows(tile, within);
  const auto pixels_of = [&](const CoveredRow& r) {
    return PixelRow(tile.x0 + r.first, r.count, tile.y0 + r.row, map.origin_px);
  };
  const auto expect = [&](const auto& row) {
    if constexpr (requires { lookup.expect_row(pixels_of(*row)); })
      if (row != rows.all().end()) lookup.expect_row(pixels_of(*row));
  };
  expect(rows.all().begin());
  const RowIrradiance irradiance = row_irradiance(of, tile);
  using Light = PixelLight<Lookup::kMonochrome>;
  const Light light(irradiance);
  for (auto at = rows.all().begin(); at != rows.all().end(); ++at) {
    const CoveredRow& r = *at;
    const PixelRow pixels = pixels_of(r);
    lookup.set_row(pixels);
    expect(at + 1);
    const RowOfPixels row(tile, r);
    const typename Light::Row light_of_row(light, r);
    const Groups all = first_groups((r.count + kGroup - 1) / kGroup);
    if constexpr (requires { lookup.uniform(pixels); }) {
      if (r.count > kShort) {
        const UniformGroups uniform = lookup.uniform(pixels);
        add_row(tile, row, irradiance, uniform, lookup.lookup(pixels, all & ~(uniform.dark | uniform.level)),
                light_of_row);
        continue;
      }
    }
    add_row(tile, row, lookup.lookup(pixels, all), light_of_row);
  }
}

void add_patterned(TileSums& tile, const PolygonList& list, const Polygon& polygon, const TileInput& input) {
  tile.make_light();
  const PixelRows within = rows_under(tile, list.corners_of(polygon));
  CoverageSums& cover = tile.cover;
  cover.width = tile.width;
  cover.height = tile.height;
  cover.set_columns(within.low_column, within.high_column);
  for_each_edge(tile, list, polygon,
                [&](Vec2 a, Vec2 b, std::size_t, double sign) { add_clipped(cover, NoIrradiance(), a, b, sign); });
  const Pattern& pattern = list.patterns[polygon.pattern - 1];
  const LinearIrradiance& irradiance = list.irradiance_of(polygon);
  const auto add = [&](auto&& lookup) {
    if (pattern.samples <= 1) return add_pixels(tile, irradiance, pattern.map, within, lookup);
    MeanOfSamples mean(lookup, static_cast<int>(pattern.samples));
    add_pixels(tile, irradiance, pattern.map, within, mean);
  };
  if (pattern.kind == PatternKind::Pixels) return add(PixelTable(list, pattern));
  if (pattern.kind == PatternKind::Texture) {
    const TextureTable& table = *input.textures[pattern.table];
    if (table.of_one()) return add(MonochromeTexture(table, pattern));
    return add(ColourTexture(table, pattern, list.weights[pattern.weights]));
  }
  const EdgeTable& table = list.edge_tables[pattern.table];
  const FringeInput from{list, table, {list.active.data() + pattern.first, pattern.count}, input.outline, pattern.map};
  if (!table.is_monochrome) return add(Fringes(from));
  if (from.edges() == 1 && !table.of_outline) return add(MonochromeFringe(from));
  add(MonochromeFringes(from));
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
