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
#include <cstddef>

#include "render/adaptive/quad-inl.h"
#include "render/adaptive/tile_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

static_assert(screens::BandPattern::kStride == 4);

// A row's places in a pattern's samples.
class PatternRow {
 public:
  PatternRow(const screens::BandPattern::Level& level, double extent) : level_(level), extent_(extent) {}

  void look(const PixelRow& row, Seen* seen) {
    const FloatTag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    // With the border's sample the first middle is at 1.
    const auto per_radius = hn::Set(d, static_cast<float>(0.5 * level_.side / extent_));
    const auto centre = hn::Set(d, static_cast<float>(0.5 * level_.side + 0.5));
    const auto most = static_cast<float>(level_.side + 1);
    const auto beyond = [&](auto place) {
      return hn::AllTrue(d, hn::Le(place, hn::Zero(d))) || hn::AllTrue(d, hn::Ge(place, hn::Set(d, most)));
    };
    for (int k = 0; k < row.count; k += lanes) {
      const auto column = hn::MulAdd(hn::Load(d, row.stop_x + k), per_radius, centre);
      const auto line = hn::NegMulAdd(hn::Load(d, row.stop_y + k), per_radius, centre);
      column_.put(k, column, most);
      line_.put(k, line, most);
      seen[k / lanes] = beyond(column) || beyond(line) ? Seen::Dark : Seen::Varied;
    }
  }

  // The sample left of and above a place, of so many values each, and the place's distances from it.
  [[nodiscard]] HWY_INLINE const float* sample(int k, std::size_t stride) const {
    return level_.samples.data() +
           stride * (static_cast<std::size_t>(line_.whole[k]) * pitch() + static_cast<std::size_t>(column_.whole[k]));
  }
  [[nodiscard]] std::size_t pitch() const { return static_cast<std::size_t>(level_.pitch()); }
  [[nodiscard]] HWY_INLINE float right(int k) const { return column_.rest[k]; }
  [[nodiscard]] HWY_INLINE float down(int k) const { return line_.rest[k]; }

 private:
  const screens::BandPattern::Level& level_;
  double extent_;
  TableRow column_, line_;
};

// All channels, each wavelength's part by its own weights.
class Pattern {
 public:
  static constexpr bool kGrey = false;
  Pattern(const BandScreen& screen, double width) : row_(screen.pattern->level_for(width), screen.pattern->extent()) {
    for (std::size_t k = 0; k < screen.parts.size(); ++k)
      std::copy_n(screen.parts[k].channel.data(), 3, channel_[k].data());
  }

  void look(const PixelRow& row) { row_.look(row, seen_); }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] HWY_INLINE Quad passed(int k) const {
    const float* const above = row_.sample(k, kStride);
    const float* const below = above + kStride * row_.pitch();
    const Quad right = Quad::all(row_.right(k));
    const Quad value = mix(mix(Quad::load(above), Quad::load(above + kStride), right),
                           mix(Quad::load(below), Quad::load(below + kStride), right), Quad::all(row_.down(k)));
    const auto of = [&](std::size_t part) { return Quad::load(channel_[part].data()); };
    return multiply_add(value.broadcast<0>(), of(0),
                        multiply_add(value.broadcast<1>(), of(1), value.broadcast<2>() * of(2)));
  }

 private:
  static constexpr std::size_t kStride = screens::BandPattern::kStride;
  PatternRow row_;
  std::array<std::array<float, TileSums::kPixel>, screens::BandPattern::kMost> channel_{};
  Seen seen_[kMostGroups];
};

// Of a single wavelength, one value for all channels.
class GreyPattern {
 public:
  static constexpr bool kGrey = true;
  GreyPattern(const screens::BandPattern& pattern, double width) : row_(pattern.level_for(width), pattern.extent()) {}

  void look(const PixelRow& row) {
    row_.look(row, seen_);
    const auto mixed = [](float a, float b, float rest) { return a + rest * (b - a); };
    for (int k = 0; k < row.count; ++k) {
      const float* const above = row_.sample(k, 1);
      const float* const below = above + row_.pitch();
      const float right = row_.right(k);
      passed_[k] = mixed(mixed(above[0], above[1], right), mixed(below[0], below[1], right), row_.down(k));
    }
  }
  [[nodiscard]] Seen seen(int group) const { return seen_[group]; }
  [[nodiscard]] const float* passed() const { return passed_; }

 private:
  PatternRow row_;
  HWY_ALIGN float passed_[kRowRoom];
  Seen seen_[kMostGroups];
};

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
