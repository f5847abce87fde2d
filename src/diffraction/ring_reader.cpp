#include "diffraction/ring_reader.h"

#include <algorithm>

#include "kernels/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffraction/ring_reader.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h: it is compiled once for each target.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using Pixel = hn::CappedTag<float, 4>;

constexpr float kInverse_pi = 0.318309886F;

// Rows above and directions on both sides of one place.
HWY_INLINE void read_place(const StarburstRings& rings, float octaves, float turns, float* rgb) {
  const std::size_t o = std::min(static_cast<std::size_t>(octaves), rings.octaves.size() - 1);
  const StarburstOctave& octave = rings.octaves[o];
  const float row = (octaves - static_cast<float>(o)) * kRowsPerOctave;
  const std::size_t row0 = std::min(static_cast<std::size_t>(row), static_cast<std::size_t>(kRowsPerOctave - 1));
  const float place = turns * static_cast<float>(octave.angles) + 0.5F;  // 0.5 so that it never is negative
  const auto whole = static_cast<std::size_t>(place);
  const std::size_t a0 = whole == 0 || whole > octave.angles ? octave.angles - 1 : whole - 1;
  const std::size_t a1 = whole >= octave.angles ? 0 : whole;
  const Pixel d;
  const auto t = hn::Set(d, std::min(row - static_cast<float>(row0), 1.0F));
  const auto s = hn::Set(d, place - static_cast<float>(whole));
  const float *p00 = octave.at(row0, a0), *p01 = octave.at(row0, a1);
  const float *p10 = octave.at(row0 + 1, a0), *p11 = octave.at(row0 + 1, a1);
  HWY_ALIGN float value[4];
  for (std::size_t c = 0; c < 4; c += hn::Lanes(d)) {
    const auto first = hn::LoadU(d, p00 + c), second = hn::LoadU(d, p10 + c);
    const auto above = hn::MulAdd(s, hn::Sub(hn::LoadU(d, p01 + c), first), first);
    const auto below = hn::MulAdd(s, hn::Sub(hn::LoadU(d, p11 + c), second), second);
    hn::Store(hn::MulAdd(t, hn::Sub(below, above), above), d, value + c);
  }
  std::copy_n(value, 3, rgb);
}

void read_rings(const StarburstRings& rings, double x0, double y, std::size_t count, float* rgb) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  const auto first2 = static_cast<float>(1.0 / (rings.first_px * rings.first_px));
  const auto last_octaves = static_cast<float>(rings.octaves.size());
  HWY_ALIGN float octaves[16], turns[16];
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto x = hn::Add(hn::Set(d, static_cast<float>(x0 + static_cast<double>(i))), hn::Iota(d, 0.0F));
    const auto v = hn::Set(d, static_cast<float>(-y));
    const auto r2 = hn::Max(hn::Mul(hn::MulAdd(x, x, hn::Mul(v, v)), hn::Set(d, first2)), hn::Set(d, 1e-12F));
    hn::Store(hn::Mul(hn::Log2(d, r2), hn::Set(d, 0.5F)), d, octaves);
    // Half a turn from straight down: atan(y / x) / pi + 1 / 2. On the vertical through the centre it is either end.
    const auto nonzero = hn::IfThenElse(hn::Eq(x, hn::Zero(d)), hn::Set(d, 1e-12F), x);
    const auto angle = hn::Atan(d, hn::Div(v, nonzero));
    hn::Store(hn::Clamp(hn::MulAdd(angle, hn::Set(d, kInverse_pi), hn::Set(d, 0.5F)), hn::Zero(d), hn::Set(d, 1.0F)), d,
              turns);
    for (std::size_t k = 0; k < std::min(lanes, count - i); ++k) {
      float* const out = rgb + 3 * (i + k);
      if (octaves[k] >= 0.0F && octaves[k] < last_octaves)
        read_place(rings, octaves[k], turns[k], out);
      else
        std::fill_n(out, 3, 0.0F);
    }
  }
}

}  // namespace contrejour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour {

HWY_EXPORT(read_rings);

void read_rings(const StarburstRings& rings, double x0, double y, std::size_t count, float* rgb) {
  HWY_DYNAMIC_DISPATCH(read_rings)(rings, x0, y, count, rgb);
}

}  // namespace contrejour
#endif  // HWY_ONCE
