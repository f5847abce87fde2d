// SPDX-License-Identifier: Apache-2.0
#include "diffraction/ring_reader.h"

#include <algorithm>

#include "base/simd_targets.h"
#include "diffraction/sharp_zone.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffraction/ring_reader.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h: it is compiled once for each target.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using Pixel = hn::CappedTag<float, 4>;

constexpr float kInverse_pi = 0.318309886F;

// A position among the rings: between a row and the next, and in half turns.
struct RingPosition {
  std::size_t row = 0;
  float below = 0.0F;  // 0..1, from the row to the next
  float turns = 0.0F;
};

// Interpolates means over pixels between the rows and the bins' edges on both sides.
HWY_INLINE void read_means(const StarburstOctave& octave, std::size_t bin, const RingPosition& at, float* rgb) {
  const Pixel d;
  const auto t = hn::Set(d, at.below);
  const auto s = hn::Set(d, std::min(at.turns * static_cast<float>(octave.bins) - static_cast<float>(bin), 1.0F));
  const float *above = octave.at(at.row, bin), *below = octave.at(at.row + 1, bin);
  HWY_ALIGN float value[4];
  for (std::size_t c = 0; c < 4; c += hn::Lanes(d)) {
    const auto first = hn::LoadU(d, above + c), second = hn::LoadU(d, below + c);
    const auto upper = hn::MulAdd(s, hn::Sub(hn::LoadU(d, above + 4 + c), first), first);
    const auto lower = hn::MulAdd(s, hn::Sub(hn::LoadU(d, below + 4 + c), second), second);
    hn::Store(hn::MulAdd(t, hn::Sub(lower, upper), upper), d, value + c);
  }
  std::copy_n(value, 3, rgb);
}

HWY_INLINE void read_position(const StarburstRings& rings, float octaves, float turns, Vec2 p, float* rgb) {
  const std::size_t o = std::min(static_cast<std::size_t>(octaves), rings.octaves.size() - 1);
  const StarburstOctave& octave = rings.octaves[o];
  const float row = (octaves - static_cast<float>(o)) * kRowsPerOctave;
  RingPosition at;
  at.row = std::min(static_cast<std::size_t>(row), static_cast<std::size_t>(kRowsPerOctave - 1));
  at.below = std::min(row - static_cast<float>(at.row), 1.0F);
  at.turns = turns;
  const std::size_t bin = std::min(static_cast<std::size_t>(turns * static_cast<float>(octave.bins)), octave.bins - 1);
  if (octave.zones.empty() || octave.zone_of_bin[bin] == 0) return read_means(octave, bin, at, rgb);
  const SharpZone& zone = octave.zones[static_cast<std::size_t>(octave.zone_of_bin[bin] - 1)];
  read_zone(zone, octave.bins, row, turns, p, rgb);
}

void read_rings(const StarburstRings& rings, double x0, double y, std::size_t count, float* rgb) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  const auto first2 = static_cast<float>(1.0 / (rings.first_px * rings.first_px));
  const auto last_octaves = static_cast<float>(rings.octaves.size());
  const double near2 = kNear_px * kNear_px - y * y;
  HWY_ALIGN float octaves[16], turns[16];
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto x = hn::Add(hn::Set(d, static_cast<float>(x0 + static_cast<double>(i))), hn::Iota(d, 0.0F));
    const auto v = hn::Set(d, static_cast<float>(-y));
    const auto r2 = hn::Max(hn::Mul(hn::MulAdd(x, x, hn::Mul(v, v)), hn::Set(d, first2)), hn::Set(d, 1e-12F));
    hn::Store(hn::Mul(hn::Log2(d, r2), hn::Set(d, 0.5F)), d, octaves);
    // Half a turn from straight down: atan(y / x) / pi + 1 / 2. On the vertical through the centre either end is
    // correct.
    const auto nonzero = hn::IfThenElse(hn::Eq(x, hn::Zero(d)), hn::Set(d, 1e-12F), x);
    const auto angle = hn::Atan(d, hn::Div(v, nonzero));
    hn::Store(hn::Clamp(hn::MulAdd(angle, hn::Set(d, kInverse_pi), hn::Set(d, 0.5F)), hn::Zero(d), hn::Set(d, 1.0F)), d,
              turns);
    for (std::size_t k = 0; k < std::min(lanes, count - i); ++k) {
      float* const out = rgb + 3 * (i + k);
      const double from_x = x0 + static_cast<double>(i + k);
      if (from_x * from_x >= near2 && octaves[k] < last_octaves)
        read_position(rings, octaves[k], turns[k], {from_x, -y}, out);
      else
        std::fill_n(out, 3, 0.0F);
    }
  }
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {

HWY_EXPORT(read_rings);

void read_rings(const StarburstRings& rings, double x0, double y, std::size_t count, float* rgb) {
  HWY_DYNAMIC_DISPATCH(read_rings)(rings, x0, y, count, rgb);
}

}  // namespace contrejour::inline internal
#endif  // HWY_ONCE
