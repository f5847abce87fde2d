// A row of pixels, where its light crosses the stop, and where that is in tables.
#if defined(CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "render/adaptive/polygon_list.h"
#include "render/adaptive/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;

constexpr std::size_t kRowRoom = TileGrid::kWidth + hn::MaxLanes(FloatTag());

// Some pixels of a row of the frame; where their light crosses the stop.
struct PixelRow {
  int first = 0, count = 0;  // columns of the frame
  int y = 0;
  HWY_ALIGN float stop_x[kRowRoom], stop_y[kRowRoom];

  [[nodiscard]] Vec2 pixel(int k) const { return {first + k + 0.5, y + 0.5}; }
  [[nodiscard]] Vec2 stop(int k) const { return {static_cast<double>(stop_x[k]), static_cast<double>(stop_y[k])}; }
  void look_at_stop(const StopMap& map);
};

void PixelRow::look_at_stop(const StopMap& map) {
  const FloatTag d;
  const StopMap::Row row = map.row(y + 0.5);
  const auto from = hn::Set(d, static_cast<float>(first + 0.5 - map.origin().x));
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

// A place between entries of a table: whole steps, and the rest. Places that are no numbers count as 0.
struct TableRow {
  HWY_ALIGN std::int32_t whole[kRowRoom];
  HWY_ALIGN float rest[kRowRoom];

  // place: 0 to most; the last step is one that has an entry after it.
  HWY_INLINE void put(int k, hn::Vec<FloatTag> place, float most) {
    const FloatTag d;
    const IntTag di;
    const auto within = hn::Min(hn::IfThenElseZero(hn::Gt(place, hn::Zero(d)), place), hn::Set(d, most));
    const auto steps = hn::Min(hn::ConvertTo(di, within), hn::Set(di, static_cast<std::int32_t>(most) - 1));
    hn::Store(steps, di, whole + k);
    hn::Store(hn::Sub(within, hn::ConvertTo(d, steps)), d, rest + k);
  }
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
