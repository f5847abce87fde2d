// What passes screens that dim all channels alike, those of a single wavelength: one value a pixel.
#if defined(CONTREJOUR_ADAPTIVE_TILE_GREY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_GREY_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_GREY_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_GREY_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "render/adaptive/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

// The product of what several edges bring.
class GreyFringes {
 public:
  static constexpr bool kGrey = true;

  GreyFringes(const EdgeTable& table, std::span<const std::uint16_t> active)
      : table_(table), active_(active), per_step_(static_cast<float>(table.per_step())),
        dark_(static_cast<float>(table.dark_beyond() * table.per_step())),
        most_(static_cast<float>(table.count() - 1)) {}

  void look(const PixelRow& row) {
    const FloatTag d;
    std::fill_n(passed_, row.count, 1.0F);
    std::fill_n(seen_, row.count, Seen::Level);
    const IrisShape& iris = table_.iris();
    if (iris.is_picture()) {
      HWY_ALIGN float distance[hn::MaxLanes(FloatTag())] = {};
      return apply(row, [&](int k) {
        for (int j = 0; j < static_cast<int>(hn::Lanes(d)) && k + j < row.count; ++j)
          distance[j] = static_cast<float>(iris.picture_distance(row.stop(k + j)));
        return hn::Load(d, distance);
      });
    }
    for (const std::uint16_t bound : active_)
      apply(row, [&](int k) {
        return distance_from(iris.bounds()[bound], hn::Load(d, row.stop_x + k), hn::Load(d, row.stop_y + k));
      });
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] const float* passed() const { return passed_; }

 private:
  template <class DistanceAt>
  HWY_INLINE void apply(const PixelRow& row, const DistanceAt& distance_at) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto most = hn::Set(d, most_);
    for (int k = 0; k < row.count; k += lanes) {
      Seen& seen = seen_[k / lanes];
      if (seen == Seen::Dark) continue;
      const auto place = hn::NegMulAdd(distance_at(k), hn::Set(d, per_step_), hn::Set(d, dark_));
      if (hn::AllTrue(d, hn::Ge(place, most))) continue;
      seen = hn::AllTrue(d, hn::Le(place, hn::Zero(d))) ? Seen::Dark : Seen::Varied;
      if (seen == Seen::Dark) continue;
      at_.put(k, place, most_);
      const int end = std::min(k + lanes, row.count);
      for (int j = k; j < end; ++j) {
        const float* const entry = table_.entries() + at_.whole[j];
        passed_[j] *= entry[0] + at_.rest[j] * (entry[1] - entry[0]);
      }
    }
  }

  const EdgeTable& table_;
  std::span<const std::uint16_t> active_;
  float per_step_, dark_, most_;
  TableRow at_;
  HWY_ALIGN float passed_[kRowRoom];
  Seen seen_[kMostGroups];
};

// A pattern of all the iris.
class GreyPattern {
 public:
  static constexpr bool kGrey = true;

  GreyPattern(const screens::BandPattern& pattern, double width)
      : level_(pattern.level_for(width)), scale_(0.5 * level_.side / pattern.extent()) {}

  void look(const PixelRow& row) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    // With the border's sample the first middle is at 1.
    const auto scale = hn::Set(d, static_cast<float>(scale_));
    const auto centre = hn::Set(d, static_cast<float>(0.5 * level_.side + 0.5));
    const auto most = static_cast<float>(level_.side + 1);
    const auto beyond = [&](auto place) {
      return hn::AllTrue(d, hn::Le(place, hn::Zero(d))) || hn::AllTrue(d, hn::Ge(place, hn::Set(d, most)));
    };
    for (int k = 0; k < row.count; k += lanes) {
      const auto column = hn::MulAdd(hn::Load(d, row.stop_x + k), scale, centre);
      const auto line = hn::NegMulAdd(hn::Load(d, row.stop_y + k), scale, centre);
      seen_[k / lanes] = beyond(column) || beyond(line) ? Seen::Dark : Seen::Varied;
      column_.put(k, column, most);
      row_.put(k, line, most);
    }
    const auto pitch = static_cast<std::size_t>(level_.pitch());
    for (int k = 0; k < row.count; ++k) {
      const float* const at =
          level_.samples.data() + static_cast<std::size_t>(row_.whole[k]) * pitch + column_.whole[k];
      const float right = column_.rest[k];
      const float above = at[0] + right * (at[1] - at[0]);
      const float below = at[pitch] + right * (at[pitch + 1] - at[pitch]);
      passed_[k] = above + row_.rest[k] * (below - above);
    }
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] const float* passed() const { return passed_; }

 private:
  const screens::BandPattern::Level& level_;
  double scale_;
  TableRow column_, row_;
  HWY_ALIGN float passed_[kRowRoom];
  Seen seen_[kMostGroups];
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
