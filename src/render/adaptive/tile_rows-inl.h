// A row of pixels, where its light crosses the stop, and where that is in tables.
#if defined(CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "render/adaptive/polygon_list.h"
#include "render/adaptive/tile_sums.h"
#include "render/screens/short_light.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::CappedTag<float, 8>;  // rows of polygons are some twenty pixels long
using IntTag = hn::RebindToSigned<FloatTag>;

constexpr std::size_t kRowRoom = TileGrid::kWidth + hn::MaxLanes(FloatTag());

// Some pixels of a row of the frame; where their light crosses the stop.
struct PixelRow {
  int first = 0, count = 0;  // columns of the frame
  int y = 0;
  HWY_ALIGN float stop_x[kRowRoom], stop_y[kRowRoom];

  [[nodiscard]] Vec2 pixel(int k) const { return {first + k + 0.5, y + 0.5}; }
  [[nodiscard]] Vec2 stop(int k) const { return {static_cast<double>(stop_x[k]), static_cast<double>(stop_y[k])}; }
  // row: of the map whose origin is there.
  void look_at_stop(const StopMap::Row& row, double origin_x);
};

void PixelRow::look_at_stop(const StopMap::Row& row, double origin_x) {
  const FloatTag d;
  const auto from = hn::Set(d, static_cast<float>(first + 0.5 - origin_x));
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d))) {
    const auto x = hn::Add(from, hn::Iota(d, static_cast<float>(k)));
    const auto along = [&](float c0, float c1, float c2) {
      return hn::MulAdd(x, hn::MulAdd(x, hn::Set(d, c2), hn::Set(d, c1)), hn::Set(d, c0));
    };
    hn::Store(along(row.x0, row.x1, row.x2), d, stop_x + k);
    hn::Store(along(row.y0, row.y1, row.y2), d, stop_y + k);
  }
}

// What a few pixels side by side see, as many as a vector has floats.
enum class Seen : std::uint8_t { Dark, Level, Varied };
constexpr std::size_t kMostGroups = TileGrid::kWidth;  // where vectors hold one

// Places between entries of a table: whole steps, and the rest. Places that are no numbers count as 0.
struct TablePlaces {
  hn::Vec<IntTag> whole;
  hn::Vec<FloatTag> rest;

  // place: 0 to most; the last step is one that has an entry after it.
  HWY_INLINE TablePlaces(hn::Vec<FloatTag> place, float most) {
    const FloatTag d;
    const IntTag di;
    const auto within = hn::Min(hn::IfThenElseZero(hn::Gt(place, hn::Zero(d)), place), hn::Set(d, most));
    whole = hn::Min(hn::ConvertTo(di, within), hn::Set(di, static_cast<std::int32_t>(most) - 1));
    rest = hn::Sub(within, hn::ConvertTo(d, whole));
  }
};

// Those of a row.
struct TableRow {
  HWY_ALIGN std::int32_t whole[kRowRoom];
  HWY_ALIGN float rest[kRowRoom];

  HWY_INLINE void put(int k, hn::Vec<FloatTag> place, float most) {
    const TablePlaces at(place, most);
    hn::Store(at.whole, IntTag(), whole + k);
    hn::Store(at.rest, FloatTag(), rest + k);
  }
};

// A table of ShortLight.
class ShortTable {
 public:
  ShortTable(const std::vector<std::uint16_t>& coded, const screens::ShortLight& coding)
      : coded_(coded.data()), coding_(coding) {}

  // Between entries `whole` and the ones after them; more than the light by none().
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> between(hn::Vec<IntTag> whole, hn::Vec<FloatTag> rest) const {
    constexpr int kShift = screens::ShortLight::kShift;
    const FloatTag d;
    const IntTag di;
    const auto pair = pairs_at(whole);
    const auto bits = hn::Set(di, 0xFFFF << kShift), lowest = hn::Set(di, coding_.lowest());
    const auto low = hn::BitCast(d, hn::Add(hn::And(hn::ShiftLeft<kShift>(pair), bits), lowest));
    const auto high = hn::BitCast(d, hn::Add(hn::And(hn::ShiftRight<16 - kShift>(pair), bits), lowest));
    constexpr bool kLowFirst = std::endian::native == std::endian::little;
    const auto first = kLowFirst ? low : high, second = kLowFirst ? high : low;
    return hn::MulAdd(rest, hn::Sub(second, first), first);
  }
  HWY_INLINE void fetch(std::ptrdiff_t entry) const { hwy::Prefetch(coded_ + entry); }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> none() const { return hn::Set(FloatTag(), coding_.none()); }

 private:
  // Two entries each, side by side in a word.
  [[nodiscard]] HWY_INLINE hn::Vec<IntTag> pairs_at(hn::Vec<IntTag> place) const {
    const IntTag di;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2  // which gather words from any byte on
    return hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(coded_), hn::ShiftLeft<1>(place));
#else
    HWY_ALIGN std::int32_t pairs[hn::MaxLanes(IntTag())];
    hn::Store(place, di, pairs);
    for (std::int32_t& pair : pairs) std::memcpy(&pair, coded_ + pair, sizeof pair);
    return hn::Load(di, pairs);
#endif
  }

  const std::uint16_t* coded_;
  screens::ShortLight coding_;
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
