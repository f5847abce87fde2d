// SPDX-License-Identifier: Apache-2.0
// The transmittance of a diffraction pattern of the whole iris, from images over the stop.
#if defined(CONTREJOUR_ADAPTIVE_TILE_TEXTURES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_TEXTURES_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_TEXTURES_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_TEXTURES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/adaptive/tiles/channel_vector-inl.h"
#include "render/adaptive/tiles/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

static_assert(TextureTable::kStride == kVectorChannels);

// Positions in a pattern's samples along rows. No pixels are sorted out as dark, since bounding polygons have clipped
// the dark parts.
class PatternPositions {
 public:
  PatternPositions(const TextureTable::Level& level, double extent, const PatternMap& map)
      : largest_(static_cast<float>(level.side + 1)) {
    const double per_radius = 0.5 * level.side / extent;
    const double centre = 0.5 * level.side + 0.5;  // with a border of one sample, the middle of the first one is at 1
    column_ = RowForm(map.form({per_radius, 0.0}, centre));
    line_ = RowForm(map.form({0.0, -per_radius}, centre));
  }

  HWY_INLINE void set_row(const PixelRow& row) {
    column_.set_row(row);
    line_.set_row(row);
  }
  // The coefficients along a row in vectors.
  class Along {
   public:
    HWY_INLINE Along(const PatternPositions& all, const PixelRow& row)
        : column_(all.column_.along()), line_(all.line_.along()), end_(all.largest_), row_(row) {}
    [[nodiscard]] HWY_INLINE TablePositions across(int k) const { return end_.positions(column_.at(row_.x(k))); }
    [[nodiscard]] HWY_INLINE TablePositions down(int k) const { return end_.positions(line_.at(row_.x(k))); }

   private:
    RowForm::Along column_, line_;
    TableEnd end_;
    PixelRow row_;
  };

 private:
  float largest_;
  RowForm column_, line_;
};

// All channels, with each wavelength's part by its own weights.
class ColourTexture {
 public:
  static constexpr bool kMonochrome = false;
  ColourTexture(const TextureTable& table, const Pattern& pattern, const WavelengthWeights& weights)
      : samples_(table.samples.data() + table.levels[pattern.level].first),
        positions_(table.levels[pattern.level], table.extent, pattern.map),
        pitch_(kStride * static_cast<std::size_t>(table.levels[pattern.level].pitch())), weights_(weights) {}

  HWY_INLINE void set_row(const PixelRow& row) { positions_.set_row(row); }
  HWY_INLINE const ColourTexture& lookup(const PixelRow& row, Groups /*wanted*/) {
    const PatternPositions::Along positions(positions_, row);
    for (int k = 0; k < row.count; k += static_cast<int>(hn::MaxLanes(FloatTag()))) {
      const TablePositions across = positions.across(k), down = positions.down(k);
      hn::Store(across.whole, IntTag(), column_ + k);
      hn::Store(across.fraction, FloatTag(), right_ + k);
      hn::Store(down.whole, IntTag(), line_ + k);
      hn::Store(down.fraction, FloatTag(), below_ + k);
    }
    return *this;
  }
  [[nodiscard]] HWY_INLINE const ColourTexture& vector(int /*k*/) const { return *this; }
  [[nodiscard]] HWY_INLINE ChannelVector transmitted(int j) const {
    const float* const above =
        samples_ + static_cast<std::size_t>(line_[j]) * pitch_ + kStride * static_cast<std::size_t>(column_[j]);
    const float* const below = above + pitch_;
    const ChannelVector right = ChannelVector::all(right_[j]);
    const ChannelVector value =
        interpolate(interpolate(ChannelVector::load(above), ChannelVector::load(above + kStride), right),
                    interpolate(ChannelVector::load(below), ChannelVector::load(below + kStride), right),
                    ChannelVector::all(below_[j]));
    const auto of = [&](std::size_t part) { return ChannelVector::load(weights_[part].data()); };
    return multiply_add(value.broadcast<0>(), of(0),
                        multiply_add(value.broadcast<1>(), of(1), value.broadcast<2>() * of(2)));
  }

 private:
  static constexpr std::size_t kStride = TextureTable::kStride;
  const float* samples_;
  PatternPositions positions_;
  std::size_t pitch_;
  const WavelengthWeights& weights_;
  HWY_ALIGN std::int32_t column_[kRowCapacity], line_[kRowCapacity];
  HWY_ALIGN float right_[kRowCapacity], below_[kRowCapacity];
};

// A row's positions in a table: the first of four samples, and the fractions of the distance to the others.
struct RowPositions {
  HWY_ALIGN std::int32_t position[kRowCapacity];
  HWY_ALIGN float across[kRowCapacity], down[kRowCapacity];
};

// The pattern of a single wavelength, with one value for all channels. The positions of all of a row's pixels are
// computed while the row before is looked up, and their samples are prefetched: patterns are large, and most samples
// are needed only once.
class MonochromeTexture {
 public:
  static constexpr bool kMonochrome = true;
  MonochromeTexture(const TextureTable& table, const Pattern& pattern)
      : MonochromeTexture(table, table.levels[pattern.level], pattern.map) {}

  // Prepares the row that comes next.
  HWY_INLINE void expect_row(const PixelRow& row) {
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
    constexpr int kEvery = 2;  // pixels: a cache line holds several samples
    RowPositions& to = rows_[1 - now_];
    positions_.set_row(row);
    const PatternPositions::Along positions(positions_, row);
    const auto pitch = hn::Set(IntTag(), pitch_);
    for (int k = 0; k < row.count; k += kLanes) {
      const TablePositions across = positions.across(k), down = positions.down(k);
      hn::Store(hn::Add(hn::Mul(down.whole, pitch), across.whole), IntTag(), to.position + k);
      hn::Store(across.fraction, FloatTag(), to.across + k);
      hn::Store(down.fraction, FloatTag(), to.down + k);
    }
    for (int k = row.y % kEvery; k < row.count; k += kEvery) table_.fetch(to.position[k]);
  }
  HWY_INLINE void set_row(const PixelRow& /*expected*/) { now_ = 1 - now_; }

  class Row {
   public:
    explicit HWY_INLINE Row(const MonochromeTexture& all) : positions_(all.rows_[all.now_]), table_(all.table_) {}
    [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> transmitted(int k) const {
      const FloatTag d;
      return table_.among(positions_.position + k, hn::Load(d, positions_.across + k),
                          hn::Load(d, positions_.down + k));
    }

   private:
    const RowPositions& positions_;
    PackedTable table_;
  };
  [[nodiscard]] HWY_INLINE Row lookup(const PixelRow& /*row*/, Groups /*wanted*/) const { return Row(*this); }

 private:
  MonochromeTexture(const TextureTable& table, const TextureTable::Level& level, const PatternMap& map)
      : positions_(level, table.extent, map),
        table_(table.pairs.data() + level.first, PackedIrradiance::of_lowest(level.lowest)), pitch_(level.pitch()) {}

  PatternPositions positions_;
  PackedTable table_;
  std::int32_t pitch_;
  int now_ = 0;
  RowPositions rows_[2];
};

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
