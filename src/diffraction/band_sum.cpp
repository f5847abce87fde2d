// SPDX-License-Identifier: Apache-2.0
#include "diffraction/band_sum.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "diffraction/band_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kDirectionsAtOnce>;

void sum_bands(const std::array<float, 3>* weights, std::size_t count, const float* last_row, DirectionSums& sum) {
  const Tag d;
  for (std::size_t a = 0; a < kDirectionsAtOnce; a += hn::Lanes(d)) {
    auto r = hn::Zero(d), g = hn::Zero(d), b = hn::Zero(d);
    const float* row = last_row + a;
    for (std::size_t k = 0; k < count; ++k, row -= kDirectionsAtOnce) {
      const auto value = hn::LoadU(d, row);
      r = hn::MulAdd(hn::Set(d, weights[k][0]), value, r);
      g = hn::MulAdd(hn::Set(d, weights[k][1]), value, g);
      b = hn::MulAdd(hn::Set(d, weights[k][2]), value, b);
    }
    hn::StoreU(r, d, sum[0].data() + a);
    hn::StoreU(g, d, sum[1].data() + a);
    hn::StoreU(b, d, sum[2].data() + a);
  }
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {

HWY_EXPORT(sum_bands);

void sum_bands(std::span<const std::array<float, 3>> weights, const float* last_row, DirectionSums& sum) {
  HWY_DYNAMIC_DISPATCH(sum_bands)(weights.data(), weights.size(), last_row, sum);
}

}  // namespace contrejour::inline internal
#endif  // HWY_ONCE
