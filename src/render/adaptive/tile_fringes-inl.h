// What passes near the edges of an iris, where they bring fringes: tables of distance.
#if defined(CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_FRINGES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/adaptive/edge_table.h"
#include "render/adaptive/quad-inl.h"
#include "render/adaptive/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

static_assert(EdgeTable::kStride == 4);

// Distances from a bound of the iris.
class BoundDistance {
 public:
  explicit BoundDistance(const IrisBound& bound)
      : straight_(bound.straight()), x_(static_cast<float>(straight_ ? bound.normal.x : bound.centre.x)),
        y_(static_cast<float>(straight_ ? bound.normal.y : bound.centre.y)),
        from_(static_cast<float>(straight_ ? bound.apothem : bound.radius)) {}

  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(const PixelRow& row, int k) const {
    const FloatTag d;
    const auto x = hn::Load(d, row.stop_x + k), y = hn::Load(d, row.stop_y + k);
    const auto px = hn::Set(d, x_), py = hn::Set(d, y_), from = hn::Set(d, from_);
    if (straight_) return hn::MulAdd(px, x, hn::MulSub(py, y, from));
    const auto from_x = hn::Sub(x, px), from_y = hn::Sub(y, py);
    return hn::Sub(hn::Sqrt(hn::MulAdd(from_x, from_x, hn::Mul(from_y, from_y))), from);
  }

 private:
  bool straight_;
  float x_, y_, from_;
};

// Places in a table of fringes, by distance from an edge, and what all pixels of a vector see there.
class FringeSteps {
 public:
  explicit FringeSteps(const EdgeTable& table)
      : per_step_(static_cast<float>(table.per_step())),
        dark_(static_cast<float>(table.dark_beyond() * table.per_step())),
        most_(static_cast<float>(table.count() - 1)) {}

  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> at(hn::Vec<FloatTag> distance) const {
    const FloatTag d;
    return hn::NegMulAdd(distance, hn::Set(d, per_step_), hn::Set(d, dark_));
  }
  [[nodiscard]] HWY_INLINE Seen seen(hn::Vec<FloatTag> place) const {
    const FloatTag d;
    if (hn::AllTrue(d, hn::Ge(place, hn::Set(d, most_)))) return Seen::Level;
    return hn::AllTrue(d, hn::Le(place, hn::Zero(d))) ? Seen::Dark : Seen::Varied;
  }
  [[nodiscard]] float most() const { return most_; }

 private:
  float per_step_, dark_, most_;
};

// A row's places in a table of three channels.
class FringeRow {
 public:
  explicit FringeRow(const EdgeTable& table) : table_(table), most_(FringeSteps(table).most()) {}

  HWY_INLINE void put(int k, hn::Vec<FloatTag> place) { at_.put(k, place, most_); }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const {
    const float* const entry = table_.entries() + EdgeTable::kStride * static_cast<std::size_t>(at_.whole[k]);
    return mix(Quad::load(entry), Quad::load(entry + EdgeTable::kStride), Quad::all(at_.rest[k]));
  }

 private:
  const EdgeTable& table_;
  float most_;
  TableRow at_;
};

// One edge.
class Fringe {
 public:
  static constexpr bool kGrey = false;
  Fringe(const EdgeTable& table, const IrisBound& bound) : steps_(table), row_(table), distance_(bound) {}

  void look(const PixelRow& row) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int k = 0; k < row.count; k += lanes) {
      const auto place = steps_.at(distance_.at(row, k));
      row_.put(k, place);
      seen_[k / lanes] = steps_.seen(place);
    }
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const { return row_.passed(k); }

 private:
  FringeSteps steps_;
  FringeRow row_;
  BoundDistance distance_;
  Seen seen_[kMostGroups];
};

// Calls `visit(distance)` for each edge whose fringes are within; distance(k) is that of the pixels from k on.
// A picture's outline is one edge.
template <class Visit>
HWY_INLINE void for_each_distance(const IrisShape& iris, std::span<const std::uint16_t> active, const PixelRow& row,
                                  const Visit& visit) {
  const FloatTag d;
  if (iris.is_picture()) {
    HWY_ALIGN float distance[hn::MaxLanes(FloatTag())] = {};
    return visit([&](int k) {
      for (int j = 0; j < static_cast<int>(hn::Lanes(d)) && k + j < row.count; ++j)
        distance[j] = static_cast<float>(iris.picture_distance(row.stop(k + j)));
      return hn::Load(d, distance);
    });
  }
  for (const std::uint16_t bound : active)
    visit([&row, distance = BoundDistance(iris.bounds()[bound])](int k) { return distance.at(row, k); });
}

// Sets what the groups of a row see through several edges. multiply(k, place) is called for each edge and group, from
// pixel k on, that is neither level nor dark there.
template <class Multiply>
HWY_INLINE void look_through(const IrisShape& iris, std::span<const std::uint16_t> active, const FringeSteps& steps,
                             const PixelRow& row, Seen* groups, const Multiply& multiply) {
  const int lanes = static_cast<int>(hn::Lanes(FloatTag()));
  for (int k = 0; k < row.count; k += lanes) groups[k / lanes] = Seen::Level;
  for_each_distance(iris, active, row, [&](const auto& distance_at) {
    for (int k = 0; k < row.count; k += lanes) {
      Seen& seen = groups[k / lanes];
      if (seen == Seen::Dark) continue;
      const auto place = steps.at(distance_at(k));
      const Seen here = steps.seen(place);
      if (here == Seen::Level) continue;
      seen = here;
      if (seen != Seen::Dark) multiply(k, place);
    }
  });
}

// The product of what several edges bring.
class Fringes {
 public:
  static constexpr bool kGrey = false;
  Fringes(const EdgeTable& table, std::span<const std::uint16_t> active)
      : iris_(table.iris()), active_(active), steps_(table), one_(table) {}

  void look(const PixelRow& row) {
    std::fill_n(passed_, TileSums::kPixel * static_cast<std::size_t>(row.count), 1.0F);
    look_through(iris_, active_, steps_, row, seen_, [&](int k, hn::Vec<FloatTag> place) {
      one_.put(k, place);
      const int end = std::min(k + static_cast<int>(hn::Lanes(FloatTag())), row.count);
      for (; k < end; ++k) (passed(k) * one_.passed(k)).store(passed_ + TileSums::kPixel * static_cast<std::size_t>(k));
    });
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const {
    return Quad::load(passed_ + TileSums::kPixel * static_cast<std::size_t>(k));
  }

 private:
  const IrisShape& iris_;
  std::span<const std::uint16_t> active_;
  FringeSteps steps_;
  FringeRow one_;
  HWY_ALIGN float passed_[TileSums::kPixel * TileGrid::kWidth];
  Seen seen_[kMostGroups];
};

// The same of one value for all channels.
class GreyFringes {
 public:
  static constexpr bool kGrey = true;
  GreyFringes(const EdgeTable& table, std::span<const std::uint16_t> active)
      : iris_(table.iris()), active_(active), steps_(table), table_(table.coded(), table.coding()) {}

  void look(const PixelRow& row) {
    const FloatTag d;
    for (int k = 0; k < row.count; k += static_cast<int>(hn::Lanes(d))) hn::Store(hn::Set(d, 1.0F), d, passed_ + k);
    look_through(iris_, active_, steps_, row, seen_, [&](int k, hn::Vec<FloatTag> place) {
      const TablePlaces at(place, steps_.most());
      const auto factor = hn::Sub(table_.between(at.whole, at.rest), table_.none());
      hn::Store(hn::Mul(hn::Load(d, passed_ + k), factor), d, passed_ + k);
    });
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> passed(int k) const { return hn::Load(FloatTag(), passed_ + k); }

 private:
  const IrisShape& iris_;
  std::span<const std::uint16_t> active_;
  FringeSteps steps_;
  ShortTable table_;
  HWY_ALIGN float passed_[kRowRoom];
  Seen seen_[kMostGroups];
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
