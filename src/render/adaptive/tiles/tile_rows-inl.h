// SPDX-License-Identifier: Apache-2.0
// A row of pixels, the stop points of its light, and positions of these in tables.
#if defined(CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "render/adaptive/tiles/pixels-inl.h"
#include "render/adaptive/tiles/tile_sums.h"
#include "render/polygons/packed_irradiance.h"
#include "render/polygons/pattern_atlas.h"
#include "render/polygons/polygon_list.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

using FloatTag = RowTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;

constexpr float kToMiddle = 3.5F;  // pixels: to the middle of a group of eight

// Some pixels of a row of the frame, and the distance of the first from a map's origin.
struct PixelRow {
  int first = 0, count = 0;  // columns of the frame
  int y = 0;
  float from_x = 0, from_y = 0;  // pixels
  Vec2 in_pixel{0.5, 0.5};

  PixelRow(int first_column, int columns, int row, Vec2 origin)
      : first(first_column), count(columns), y(row), from_x(static_cast<float>(first_column + 0.5 - origin.x)),
        from_y(static_cast<float>(row + 0.5 - origin.y)) {}
  // The same pixels with another sampling point in each, displaced by `by`.
  [[nodiscard]] PixelRow moved(Vec2 by) const {
    PixelRow out = *this;
    out.from_x += static_cast<float>(by.x);
    out.from_y += static_cast<float>(by.y);
    out.in_pixel = in_pixel + by;
    return out;
  }
  [[nodiscard]] Vec2 pixel(int k) const { return Vec2{first + 0.0 + k, y + 0.0} + in_pixel; }
  // x of the pixels from k on.
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> x(int k) const {
    const FloatTag d;
    return hn::Add(hn::Add(hn::Set(d, from_x), hn::Iota(d, 0.0F)), hn::Set(d, static_cast<float>(k)));
  }
};

// A polynomial of the stop point along a row.
class RowForm {
 public:
  RowForm() = default;
  explicit RowForm(const PatternMap::Form& form) : form_(form) {}

  HWY_INLINE void set_row(const PixelRow& row) {
    level_ = form_.level + row.from_y * (form_.y + row.from_y * form_.yy);
    slope_ = form_.x + row.from_y * form_.xy;
  }
  // An upper bound of its change from the middle of a group to the ends, for all groups of the row.
  [[nodiscard]] float half_group(const PixelRow& row) const {
    const float far = std::max(std::abs(row.from_x), std::abs(row.from_x + static_cast<float>(row.count + kToMiddle)));
    return kToMiddle * kRoundingMargin * (std::abs(slope_) + 2.0F * far * std::abs(form_.xx));
  }

  // The coefficients in vectors, which no store between two pixels can change.
  struct Along {
    hn::Vec<FloatTag> level, slope, bend;
    [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(hn::Vec<FloatTag> x) const {
      return hn::MulAdd(x, hn::MulAdd(x, bend, slope), level);
    }
  };
  [[nodiscard]] HWY_INLINE Along along() const {
    const FloatTag d;
    return {hn::Set(d, level_), hn::Set(d, slope_), hn::Set(d, form_.xx)};
  }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(hn::Vec<FloatTag> x) const { return along().at(x); }

 private:
  static constexpr float kRoundingMargin = 1.01F;  // for rounding
  PatternMap::Form form_;
  float level_ = 0, slope_ = 0;
};

// Groups of eight pixels of a row, a bit for each group from the row's first pixel on. What groups see of a pattern is
// tested for all of them together, so that the work for a pixel does not wait for a test.
using Groups = std::uint64_t;
constexpr int kGroup = CoverageSums::kGroup;
static_assert(kGroup == TileSums::kBlock);
static_assert(TileGrid::kWidth <= 64 * kGroup && hn::MaxLanes(FloatTag()) <= kGroup);
constexpr std::size_t kRowCapacity = TileGrid::kWidth + kGroup;

[[nodiscard]] inline Groups first_groups(int count) {
  return count >= 64 ? ~Groups{0} : (Groups{1} << static_cast<unsigned>(count)) - 1;
}

// The groups of a row for which `test` of the positions of their middles is true.
template <class Test>
HWY_INLINE Groups groups_that(const PixelRow& row, const Test& test) {
  const FloatTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto step = hn::Set(d, static_cast<float>(kGroup));
  Groups out = 0;
  for (int group = 0; kGroup * group < row.count; group += lanes) {
    const auto x = hn::MulAdd(hn::Iota(d, static_cast<float>(group)), step, hn::Set(d, row.from_x + kToMiddle));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, test(x), bits);
    out |= Groups{bits[0]} << static_cast<unsigned>(group);
  }
  return out;
}

// Groups in which a stop pattern is dark, and groups in which it transmits all light; nothing is known of the others.
struct UniformGroups {
  Groups dark = 0, level = 0;
};

// Positions between entries of a table: the whole step, and the remaining fraction. NaN counts as 0.
struct TablePositions {
  hn::Vec<IntTag> whole;
  hn::Vec<FloatTag> fraction;
};

// Splits positions in a table whose last entry is at `largest`. The whole step is found by adding a number so large
// that no bits remain for fractions, since conversions would test for overflow. A position on an entry may count as one
// whole step after the entry before.
class TableEnd {
 public:
  explicit HWY_INLINE TableEnd(float largest)
      : largest_(hn::Set(FloatTag(), largest)), last_(hn::Set(FloatTag(), largest - 1.0F)) {}

  // The last step has an entry after it.
  [[nodiscard]] HWY_INLINE TablePositions positions(hn::Vec<FloatTag> position) const {
    const auto all = within(position);
    return positions(all, hn::Min(below(all), last_));
  }
  // The last step may be at the last entry.
  [[nodiscard]] HWY_INLINE TablePositions positions_to_end(hn::Vec<FloatTag> position) const {
    const auto all = within(position);
    return positions(all, below(all));
  }

 private:
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> within(hn::Vec<FloatTag> position) const {
    return hn::Min(hn::IfThenElseZero(hn::Gt(position, hn::Zero(FloatTag())), position), largest_);
  }
  static HWY_INLINE hn::Vec<FloatTag> below(hn::Vec<FloatTag> position) {
    return hn::Sub(position, hn::Set(FloatTag(), 0.5F));  // rounds to the step below
  }
  static HWY_INLINE TablePositions positions(hn::Vec<FloatTag> position, hn::Vec<FloatTag> step) {
    const auto no_parts = hn::Set(FloatTag(), 12582912.0F);  // 1.5 * 2^23
    const auto rounded = hn::Add(step, no_parts);
    return {hn::Sub(hn::BitCast(IntTag(), rounded), hn::BitCast(IntTag(), no_parts)),
            hn::Sub(position, hn::Sub(rounded, no_parts))};
  }

  hn::Vec<FloatTag> largest_, last_;
};

#if HWY_TARGET != HWY_SCALAR
// Eight bytes from each of these entries of a table. They are loaded one by one, as gathers are slower on many
// processors.
template <class D, class Entry>
HWY_INLINE hn::Vec<D> words_at(D d, const Entry* table, const std::int32_t* at) {
  static_assert(std::is_same_v<hn::TFromD<D>, std::uint64_t>);
  if constexpr (hn::MaxLanes(d) == 2) {
    std::uint64_t word[2];
    std::memcpy(&word[0], table + at[0], sizeof word[0]);
    std::memcpy(&word[1], table + at[1], sizeof word[1]);
    return hn::InterleaveLower(d, hn::Set(d, word[0]), hn::Set(d, word[1]));
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, words_at(half, table, at + hn::MaxLanes(half)), words_at(half, table, at));
  }
}
#endif

// The first and the second four bytes of the eight bytes from each of these entries of a table.
template <class T>
struct HalfWords {
  hn::Vec<RowTag<T>> first, second;

  template <class Entry>
  HWY_INLINE HalfWords(const Entry* table, const std::int32_t* at) {
    static_assert(sizeof(T) == 4);
    const RowTag<T> d;
#if HWY_TARGET == HWY_SCALAR
    T words[2];
    std::memcpy(words, table + *at, sizeof words);
    first = hn::Set(d, words[0]);
    second = hn::Set(d, words[1]);
#else
    const hn::Repartition<std::uint64_t, RowTag<T>> words;
    const auto low = hn::BitCast(d, words_at(words, table, at));
    const auto high = hn::BitCast(d, words_at(words, table, at + hn::MaxLanes(words)));
    first = hn::ConcatEven(d, high, low);
    second = hn::ConcatOdd(d, high, low);
#endif
  }
};

// A table of PackedIrradiance, as pairs of a sample and the one below it.
class PackedTable {
 public:
  using Pair = TextureTable::Pair;

  PackedTable(const Pair* pairs, const PackedIrradiance& coding)
      : pairs_(pairs), lowest_(hn::Set(IntTag(), coding.lowest())), none_(hn::Set(FloatTag(), coding.none())) {}

  // Interpolates between four samples: those at `position`, by the fractions to the next ones and to those below.
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> among(const std::int32_t* position, hn::Vec<FloatTag> across,
                                                   hn::Vec<FloatTag> down) const {
    const HalfWords<std::int32_t> pairs(pairs_, position);
    const auto left = between(pairs.first, down), right = between(pairs.second, down);
    return hn::Sub(hn::MulAdd(across, hn::Sub(right, left), left), none_);
  }
  HWY_INLINE void fetch(std::ptrdiff_t position) const { hwy::Prefetch(pairs_ + position); }

 private:
  // Returns the light plus none_.
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> between(hn::Vec<IntTag> pair, hn::Vec<FloatTag> fraction) const {
    constexpr int kShift = PackedIrradiance::kShift;
    const FloatTag d;
    const IntTag di;
    const auto bits = hn::Set(di, 0xFFFF << kShift);
    const auto low = hn::BitCast(d, hn::Add(hn::And(hn::ShiftLeft<kShift>(pair), bits), lowest_));
    const auto high = hn::BitCast(d, hn::Add(hn::And(hn::ShiftRight<16 - kShift>(pair), bits), lowest_));
    constexpr bool kLowFirst = std::endian::native == std::endian::little;
    const auto first = kLowFirst ? low : high, second = kLowFirst ? high : low;
    return hn::MulAdd(fraction, hn::Sub(second, first), first);
  }

  const Pair* pairs_;
  hn::Vec<IntTag> lowest_;
  hn::Vec<FloatTag> none_;
};

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
