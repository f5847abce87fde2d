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
#include <utility>

#include "render/adaptive/quad-inl.h"
#include "render/adaptive/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

static_assert(screens::BandPattern::kStride == 4);

// Places in a pattern's samples.
class PatternSteps {
 public:
  PatternSteps(const screens::BandPattern::Level& level, double extent)
      : per_radius_(static_cast<float>(0.5 * level.side / extent)),
        centre_(static_cast<float>(0.5 * level.side + 0.5)),  // with the border's sample the first middle is at 1
        most_(static_cast<float>(level.side + 1)) {}

  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> column(const PixelRow& row, int k) const {
    const FloatTag d;
    return hn::MulAdd(hn::Load(d, row.stop_x + k), hn::Set(d, per_radius_), hn::Set(d, centre_));
  }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> line(const PixelRow& row, int k) const {
    const FloatTag d;
    return hn::NegMulAdd(hn::Load(d, row.stop_y + k), hn::Set(d, per_radius_), hn::Set(d, centre_));
  }
  [[nodiscard]] HWY_INLINE Seen seen(hn::Vec<FloatTag> column, hn::Vec<FloatTag> line) const {
    const FloatTag d;
    const auto beyond = [&](auto place) HWY_ATTR {
      return hn::AllTrue(d, hn::Le(place, hn::Zero(d))) || hn::AllTrue(d, hn::Ge(place, hn::Set(d, most_)));
    };
    return beyond(column) || beyond(line) ? Seen::Dark : Seen::Varied;
  }
  [[nodiscard]] float most() const { return most_; }
  [[nodiscard]] std::pair<float, float> place(float x, float y) const {
    return {centre_ + x * per_radius_, centre_ - y * per_radius_};
  }
  [[nodiscard]] bool holds(float place) const { return place > 0.0F && place < most_; }

 private:
  float per_radius_, centre_, most_;
};

// All channels, each wavelength's part by its own weights.
class Pattern {
 public:
  static constexpr bool kGrey = false;
  Pattern(const BandScreen& screen, double width)
      : level_(screen.pattern->level_for(width)), steps_(level_, screen.pattern->extent()),
        pitch_(kStride * static_cast<std::size_t>(level_.pitch())) {
    for (std::size_t k = 0; k < screen.parts.size(); ++k)
      std::copy_n(screen.parts[k].channel.data(), 3, channel_[k].data());
  }

  void look(const PixelRow& row) {
    const int lanes = static_cast<int>(hn::Lanes(FloatTag()));
    for (int k = 0; k < row.count; k += lanes) {
      const auto column = steps_.column(row, k), line = steps_.line(row, k);
      column_.put(k, column, steps_.most());
      line_.put(k, line, steps_.most());
      seen_[k / lanes] = steps_.seen(column, line);
    }
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const {
    const float* const above = level_.samples.data() + static_cast<std::size_t>(line_.whole[k]) * pitch_ +
                               kStride * static_cast<std::size_t>(column_.whole[k]);
    const float* const below = above + pitch_;
    const Quad right = Quad::all(column_.rest[k]);
    const Quad value = mix(mix(Quad::load(above), Quad::load(above + kStride), right),
                           mix(Quad::load(below), Quad::load(below + kStride), right), Quad::all(line_.rest[k]));
    const auto of = [&](std::size_t part) { return Quad::load(channel_[part].data()); };
    return multiply_add(value.broadcast<0>(), of(0),
                        multiply_add(value.broadcast<1>(), of(1), value.broadcast<2>() * of(2)));
  }

 private:
  static constexpr std::size_t kStride = screens::BandPattern::kStride;
  const screens::BandPattern::Level& level_;
  PatternSteps steps_;
  std::size_t pitch_;
  std::array<std::array<float, TileSums::kPixel>, screens::BandPattern::kMost> channel_{};
  TableRow column_, line_;
  Seen seen_[kMostGroups];
};

// Of a single wavelength, one value for all channels.
class GreyPattern {
 public:
  static constexpr bool kGrey = true;
  GreyPattern(const screens::BandPattern& pattern, double width) : GreyPattern(pattern, pattern.level_for(width)) {}

  // Asks for what a row of pixels will look up, from the first to the last of them: patterns are far away, and most of
  // their samples are wanted but once.
  HWY_INLINE void fetch(const StopMap::Row& row, float first, float last) const {
    constexpr float kLine = 32.0F;  // samples, of memory
    constexpr int kMost = 16;
    const auto [x0, y0] = steps_.place(row.x0 + first * row.x1, row.y0 + first * row.y1);
    const auto [x1, y1] = steps_.place(row.x0 + last * row.x1, row.y0 + last * row.y1);
    const float apart = std::max(std::abs(x1 - x0) * (1.0F / kLine), std::abs(y1 - y0));
    const int pieces = apart < kMost ? static_cast<int>(apart) + 1 : kMost;
    const float part = 1.0F / static_cast<float>(pieces);
    for (int k = 0; k <= pieces; ++k) {
      const float t = static_cast<float>(k) * part;
      const float column = x0 + t * (x1 - x0), line = y0 + t * (y1 - y0);
      if (steps_.holds(column) && steps_.holds(line))
        table_.fetch(static_cast<std::ptrdiff_t>(line) * pitch_ + static_cast<std::ptrdiff_t>(column));
    }
  }

  void look(const PixelRow& row) {
    const FloatTag d;
    const IntTag di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto pitch = hn::Set(di, pitch_);
    for (int k = 0; k < row.count; k += lanes) {
      const auto column = steps_.column(row, k), line = steps_.line(row, k);
      seen_[k / lanes] = steps_.seen(column, line);
      if (seen_[k / lanes] == Seen::Dark) continue;
      const TablePlaces across(column, steps_.most()), down(line, steps_.most());
      const auto place = hn::Add(hn::Mul(down.whole, pitch), across.whole);
      const auto above = table_.between(place, across.rest), below = table_.between(hn::Add(place, pitch), across.rest);
      const auto light = hn::MulAdd(down.rest, hn::Sub(below, above), above);
      hn::Store(hn::Sub(light, table_.none()), d, passed_ + k);
    }
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE hn::Vec<FloatTag> passed(int k) const { return hn::Load(FloatTag(), passed_ + k); }

 private:
  GreyPattern(const screens::BandPattern& pattern, const screens::BandPattern::Level& level)
      : steps_(level, pattern.extent()), table_(level.coded, level.coding), pitch_(level.pitch()) {}

  PatternSteps steps_;
  ShortTable table_;
  std::int32_t pitch_;
  HWY_ALIGN float passed_[kRowRoom];
  Seen seen_[kMostGroups];
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
