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

HWY_INLINE hn::Vec<FloatTag> distance_from(const IrisBound& bound, hn::Vec<FloatTag> x, hn::Vec<FloatTag> y) {
  const FloatTag d;
  const auto set = [&](double v) { return hn::Set(d, static_cast<float>(v)); };
  if (bound.straight())
    return hn::MulAdd(set(bound.normal.x), x, hn::MulSub(set(bound.normal.y), y, set(bound.apothem)));
  const auto from_x = hn::Sub(x, set(bound.centre.x)), from_y = hn::Sub(y, set(bound.centre.y));
  return hn::Sub(hn::Sqrt(hn::MulAdd(from_x, from_x, hn::Mul(from_y, from_y))), set(bound.radius));
}

// A row's places in a table of fringes, by distance from an edge.
class FringeRow {
 public:
  explicit FringeRow(const EdgeTable& table)
      : table_(table), per_step_(static_cast<float>(table.per_step())),
        dark_(static_cast<float>(table.dark_beyond() * table.per_step())),
        most_(static_cast<float>(table.count() - 1)) {}

  HWY_INLINE Seen put(int k, hn::Vec<FloatTag> distance) {
    const FloatTag d;
    const auto place = hn::NegMulAdd(distance, hn::Set(d, per_step_), hn::Set(d, dark_));
    at_.put(k, place, most_);
    if (hn::AllTrue(d, hn::Ge(place, hn::Set(d, most_)))) return Seen::Level;
    return hn::AllTrue(d, hn::Le(place, hn::Zero(d))) ? Seen::Dark : Seen::Varied;
  }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const {
    const float* const entry = table_.entries() + EdgeTable::kStride * static_cast<std::size_t>(at_.whole[k]);
    return mix(Quad::load(entry), Quad::load(entry + EdgeTable::kStride), Quad::all(at_.rest[k]));
  }
  // Likewise, from a table of one value for all channels.
  [[nodiscard]] HWY_INLINE float grey(int k) const {
    const float* const entry = table_.entries() + at_.whole[k];
    return entry[0] + at_.rest[k] * (entry[1] - entry[0]);
  }

 private:
  const EdgeTable& table_;
  float per_step_, dark_, most_;
  TableRow at_;
};

// One edge.
class Fringe {
 public:
  static constexpr bool kGrey = false;
  Fringe(const EdgeTable& table, const IrisBound& bound) : row_(table), bound_(bound) {}

  void look(const PixelRow& row) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int k = 0; k < row.count; k += lanes)
      seen_[k / lanes] = row_.put(k, distance_from(bound_, hn::Load(d, row.stop_x + k), hn::Load(d, row.stop_y + k)));
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const { return row_.passed(k); }

 private:
  FringeRow row_;
  const IrisBound& bound_;
  Seen seen_[kMostGroups];
};

// The product of what several edges bring, all channels alike (grey) or each its own. A picture's outline is one edge.
template <bool kOneValue>
class FringeProduct {
 public:
  static constexpr bool kGrey = kOneValue;
  FringeProduct(const EdgeTable& table, std::span<const std::uint16_t> active)
      : iris_(table.iris()), active_(active), one_(table) {}

  void look(const PixelRow& row) {
    const FloatTag d;
    std::fill_n(passed_, kValues * static_cast<std::size_t>(row.count), 1.0F);
    std::fill_n(seen_, row.count, Seen::Level);
    if (iris_.is_picture()) {
      HWY_ALIGN float distance[hn::MaxLanes(FloatTag())] = {};
      return apply(row, [&](int k) {
        for (int j = 0; j < static_cast<int>(hn::Lanes(d)) && k + j < row.count; ++j)
          distance[j] = static_cast<float>(iris_.picture_distance(row.stop(k + j)));
        return hn::Load(d, distance);
      });
    }
    for (const std::uint16_t bound : active_)
      apply(row, [&](int k) {
        return distance_from(iris_.bounds()[bound], hn::Load(d, row.stop_x + k), hn::Load(d, row.stop_y + k));
      });
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }

  [[nodiscard]] const float* passed() const
    requires kOneValue
  {
    return passed_;
  }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const
    requires(!kOneValue)
  {
    return Quad::load(passed_ + kValues * static_cast<std::size_t>(k));
  }

 private:
  static constexpr std::size_t kValues = kOneValue ? 1 : EdgeTable::kStride;

  template <class DistanceAt>
  HWY_INLINE void apply(const PixelRow& row, const DistanceAt& distance_at) {
    const int lanes = static_cast<int>(hn::Lanes(FloatTag()));
    for (int k = 0; k < row.count; k += lanes) {
      Seen& seen = seen_[k / lanes];
      if (seen == Seen::Dark) continue;
      const Seen here = one_.put(k, distance_at(k));
      if (here == Seen::Level) continue;
      seen = here;
      if (seen == Seen::Dark) continue;
      const int end = std::min(k + lanes, row.count);
      for (int j = k; j < end; ++j) multiply(j);
    }
  }
  HWY_INLINE void multiply(int k) {
    if constexpr (kOneValue)
      passed_[k] *= one_.grey(k);
    else
      (passed(k) * one_.passed(k)).store(passed_ + kValues * static_cast<std::size_t>(k));
  }

  const IrisShape& iris_;
  std::span<const std::uint16_t> active_;
  FringeRow one_;
  HWY_ALIGN float passed_[kValues * kRowRoom];
  Seen seen_[kMostGroups];
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
