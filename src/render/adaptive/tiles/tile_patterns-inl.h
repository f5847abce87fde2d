// What passes where a pattern of all the iris stands: pictures over the stop.
#if defined(CONTREJOUR_ADAPTIVE_TILE_PATTERNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_PATTERNS_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_PATTERNS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_PATTERNS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/adaptive/tiles/quad-inl.h"
#include "render/adaptive/tiles/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

static_assert(screens::BandPattern::kStride == 4);

// Places in a pattern's samples along rows. Which pixels see nothing is not asked: hulls have cut off what is dark.
class PatternPlaces {
 public:
  PatternPlaces(const screens::BandPattern::Level& level, double extent, const StopMap& map)
      : most_(static_cast<float>(level.side + 1)) {
    const double per_radius = 0.5 * level.side / extent;
    const double centre = 0.5 * level.side + 0.5;  // with the border's sample the first middle is at 1
    column_ = RowForm(map.form({per_radius, 0.0}, centre));
    line_ = RowForm(map.form({0.0, -per_radius}, centre));
  }

  HWY_INLINE void set_row(const PixelRow& row) {
    column_.set_row(row);
    line_.set_row(row);
  }
  // Along a row as vectors of its own.
  class Along {
   public:
    HWY_INLINE Along(const PatternPlaces& all, const PixelRow& row)
        : column_(all.column_.along()), line_(all.line_.along()), end_(all.most_), row_(row) {}
    [[nodiscard]] HWY_INLINE TablePlaces across(int k) const { return across_at(row_.x(k)); }
    [[nodiscard]] HWY_INLINE TablePlaces down(int k) const { return down_at(row_.x(k)); }
    [[nodiscard]] HWY_INLINE TablePlaces across_at(hn::Vec<FloatTag> x) const { return end_.places(column_.at(x)); }
    [[nodiscard]] HWY_INLINE TablePlaces down_at(hn::Vec<FloatTag> x) const { return end_.places(line_.at(x)); }

   private:
    RowForm::Along column_, line_;
    TableEnd end_;
    PixelRow row_;
  };

 private:
  float most_;
  RowForm column_, line_;
};

// All channels, each wavelength's part by its own weights.
class Pattern {
 public:
  static constexpr bool kGrey = false;
  Pattern(const screens::BandScreen& screen, const StopMap& map)
      : level_(screen.pattern->level_for(map.width())), places_(level_, screen.pattern->extent(), map),
        pitch_(kStride * static_cast<std::size_t>(level_.pitch())) {
    for (std::size_t k = 0; k < screen.parts.size(); ++k)
      std::copy_n(screen.parts[k].channel.data(), 3, channel_[k].data());
  }

  HWY_INLINE void set_row(const PixelRow& row) { places_.set_row(row); }
  HWY_INLINE const Pattern& look(const PixelRow& row) {
    const PatternPlaces::Along places(places_, row);
    for (int k = 0; k < row.count; k += static_cast<int>(hn::MaxLanes(FloatTag()))) {
      const TablePlaces across = places.across(k), down = places.down(k);
      hn::Store(across.whole, IntTag(), column_ + k);
      hn::Store(across.rest, FloatTag(), right_ + k);
      hn::Store(down.whole, IntTag(), line_ + k);
      hn::Store(down.rest, FloatTag(), below_ + k);
    }
    return *this;
  }
  [[nodiscard]] HWY_INLINE const Pattern& vector(int /*k*/) const { return *this; }
  [[nodiscard]] HWY_INLINE Quad passed(int j) const {
    const float* const above = level_.samples.data() + static_cast<std::size_t>(line_[j]) * pitch_ +
                               kStride * static_cast<std::size_t>(column_[j]);
    const float* const below = above + pitch_;
    const Quad right = Quad::all(right_[j]);
    const Quad value = mix(mix(Quad::load(above), Quad::load(above + kStride), right),
                           mix(Quad::load(below), Quad::load(below + kStride), right), Quad::all(below_[j]));
    const auto of = [&](std::size_t part) { return Quad::load(channel_[part].data()); };
    return multiply_add(value.broadcast<0>(), of(0),
                        multiply_add(value.broadcast<1>(), of(1), value.broadcast<2>() * of(2)));
  }

 private:
  static constexpr std::size_t kStride = screens::BandPattern::kStride;
  const screens::BandPattern::Level& level_;
  PatternPlaces places_;
  std::size_t pitch_;
  std::array<std::array<float, kQuad>, screens::BandPattern::kMost> channel_{};
  HWY_ALIGN std::int32_t column_[kRowRoom], line_[kRowRoom];
  HWY_ALIGN float right_[kRowRoom], below_[kRowRoom];
};

// Of a single wavelength, one value for all channels.
class GreyPattern {
 public:
  static constexpr bool kGrey = true;
  GreyPattern(const screens::BandPattern& pattern, const StopMap& map)
      : GreyPattern(pattern, pattern.level_for(map.width()), map) {}

  HWY_INLINE void set_row(const PixelRow& row) { places_.set_row(row); }

  // Asks for what a row of pixels will look up: patterns are far away, and most of their samples are wanted but once.
  // Of every other pixel, and of those between in the next row: a line of memory holds several on the way to one of
  // them.
  HWY_INLINE void fetch(const PixelRow& row) {
    constexpr int kEvery = 2, kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
    const FloatTag d;
    places_.set_row(row);
    const PatternPlaces::Along places(places_, row);
    const auto pitch = hn::Set(IntTag(), pitch_);
    const auto ways = hn::Mul(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(kEvery)));
    for (int k = row.y % kEvery; k < row.count; k += kEvery * kLanes) {
      const auto x = hn::Add(ways, hn::Set(d, row.from_x + static_cast<float>(k)));
      HWY_ALIGN std::int32_t at[kLanes];
      hn::Store(hn::Add(hn::Mul(places.down_at(x).whole, pitch), places.across_at(x).whole), IntTag(), at);
      const int count = std::min(kLanes, (row.count - k + kEvery - 1) / kEvery);
      for (int j = 0; j < count; ++j) table_.fetch(at[j]);
    }
  }

  class Row {
   public:
    HWY_INLINE Row(const GreyPattern& all, const PixelRow& row)
        : places_(all.places_, row), table_(all.table_), pitch_(all.pitch_), down_(hn::Set(IntTag(), all.pitch_)) {}
    [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> passed(int k) const {
      const TablePlaces across = places_.across(k), down = places_.down(k);
      const ShortTable::Entries place(hn::Add(hn::Mul(down.whole, down_), across.whole));
      const auto above = table_.between(place, across.rest), below = table_.between(place, across.rest, pitch_);
      return hn::Sub(hn::MulAdd(down.rest, hn::Sub(below, above), above), table_.none());
    }

   private:
    PatternPlaces::Along places_;
    ShortTable table_;
    std::ptrdiff_t pitch_;
    hn::Vec<IntTag> down_;
  };
  [[nodiscard]] HWY_INLINE Row look(const PixelRow& row) const { return {*this, row}; }

 private:
  GreyPattern(const screens::BandPattern& pattern, const screens::BandPattern::Level& level, const StopMap& map)
      : places_(level, pattern.extent(), map), table_(level.coded, level.coding), pitch_(level.pitch()) {}

  PatternPlaces places_;
  ShortTable table_;
  std::int32_t pitch_;
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
