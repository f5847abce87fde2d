// SPDX-License-Identifier: Apache-2.0
#include "diffraction/sheet_rows.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffraction/sheet_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;

void blend_rows(const float* above, const float* below, float t, std::size_t count, float* out) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto first = hn::LoadU(d, above + i);
    hn::StoreU(hn::MulAdd(hn::Set(d, t), hn::Sub(hn::LoadU(d, below + i), first), first), d, out + i);
  }
  for (; i < count; ++i) out[i] = above[i] + t * (below[i] - above[i]);
}

void add_between(const float* samples, float t, const std::array<float, 3>& scale, std::size_t count, float* pixels) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float scales[48];  // whole cycles of R, G, B in any vector's lanes
  for (std::size_t k = 0; k < 48; ++k) scales[k] = scale[k % 3];
  std::size_t i = 0;
  for (; i + 3 * lanes <= count; i += 3 * lanes) {
    for (std::size_t k = 0; k < 3 * lanes; k += lanes) {
      const auto first = hn::LoadU(d, samples + i + k);
      const auto value = hn::MulAdd(hn::Set(d, t), hn::Sub(hn::LoadU(d, samples + i + k + 3), first), first);
      hn::StoreU(hn::MulAdd(value, hn::Load(d, scales + k), hn::LoadU(d, pixels + i + k)), d, pixels + i + k);
    }
  }
  for (; i < count; ++i) pixels[i] += scale[i % 3] * (samples[i] + t * (samples[i + 3] - samples[i]));
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {

HWY_EXPORT(blend_rows);
HWY_EXPORT(add_between);

void blend_rows(const float* above, const float* below, float t, std::size_t count, float* out) {
  HWY_DYNAMIC_DISPATCH(blend_rows)(above, below, t, count, out);
}

void add_between(const float* samples, float t, const std::array<float, 3>& scale, std::size_t count, float* pixels) {
  HWY_DYNAMIC_DISPATCH(add_between)(samples, t, scale, count, pixels);
}

}  // namespace contrejour::inline internal
#endif  // HWY_ONCE
