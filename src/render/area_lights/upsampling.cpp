// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/upsampling.h"

#include <cstdint>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/area_lights/upsampling.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::area::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct Upsampled {
  hn::Vec<D> first, second;
};

// The flux of two halves of some values, from the values before and after them.
struct Interpolating {
  // The excess of the first half over half of the value: 22 / 256 and 3 / 256 of the differences.
  template <class D>
  HWY_INLINE Upsampled<D> operator()(D d, const RowsAround& at, std::size_t k) const {
    const auto value = [&](std::size_t row) HWY_ATTR { return hn::LoadU(d, at[row] + k); };
    const auto half = hn::Mul(hn::Set(d, 0.5F), value(2));
    const auto near = hn::Mul(hn::Set(d, 22.0F / 256.0F), hn::Sub(value(1), value(3)));
    const auto more = hn::NegMulAdd(hn::Set(d, 3.0F / 256.0F), hn::Sub(value(0), value(4)), near);
    const auto smallest = hn::Min(hn::Min(value(0), value(1)), hn::Min(hn::Min(value(3), value(4)), half));
    const auto limited = hn::Min(hn::Max(more, hn::Neg(half)), half);
    const auto kept = hn::IfThenElse(hn::Ge(smallest, hn::Zero(d)), limited, more);
    return {hn::Add(half, kept), hn::Sub(half, kept)};
  }
};
struct Smooth {
  template <class D>
  HWY_INLINE Upsampled<D> operator()(D d, const RowsAround& at, std::size_t k) const {
    const auto eighth = hn::Set(d, 0.125F);
    const auto own = hn::Mul(hn::Set(d, 0.375F), hn::LoadU(d, at[2] + k));
    return {hn::MulAdd(eighth, hn::LoadU(d, at[1] + k), own), hn::MulAdd(eighth, hn::LoadU(d, at[3] + k), own)};
  }
};

using Tag = hn::CappedTag<float, 16>;
using One = hn::CappedTag<float, 1>;

template <class Method>
HWY_INLINE void halve_down_by(const Method& method, const RowsAround& rows, std::size_t count, float* upper,
                              float* lower) {
  const auto halve = [&](auto d, std::size_t k) HWY_ATTR {
    const auto upsampled = method(d, rows, k);
    hn::StoreU(upsampled.first, d, upper + k);
    hn::StoreU(upsampled.second, d, lower + k);
  };
  std::size_t k = 0;
  for (; k + hn::Lanes(Tag()) <= count; k += hn::Lanes(Tag())) halve(Tag(), k);
  for (; k < count; ++k) halve(One(), k);
}

// For two vectors of whole pixels with both halves interleaved: the lane from which each float comes, and from which
// half.
template <std::size_t kLanes>
struct SideBySide {
  alignas(64) std::int32_t lane[2 * kLanes];
  alignas(64) std::int32_t is_second[2 * kLanes];
  constexpr SideBySide() : lane(), is_second() {
    for (std::size_t k = 0; k < 2 * kLanes; ++k) {
      lane[k] = static_cast<std::int32_t>((k / 6 * 3 + k % 3) % kLanes);
      is_second[k] = k / 3 % 2 == 1 ? 1 : 0;
    }
  }
};

// Stores as many whole pixels as a vector holds; some floats after them are overwritten.
template <class D>
HWY_INLINE void store_side_by_side(D d, const Upsampled<D>& upsampled, float* to) {
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  if constexpr (kLanes >= 6) {
    static constexpr SideBySide<kLanes> kPositions;
    const hn::RebindToSigned<D> di;
    for (std::size_t k = 0; k < 2 * kLanes; k += kLanes) {
      const auto lanes = hn::SetTableIndices(d, kPositions.lane + k);
      const auto is_second = hn::RebindMask(d, hn::Ne(hn::Load(di, kPositions.is_second + k), hn::Zero(di)));
      const auto first = hn::TableLookupLanes(upsampled.first, lanes);
      const auto second = hn::TableLookupLanes(upsampled.second, lanes);
      hn::StoreU(hn::IfThenElse(is_second, second, first), d, to + k);
    }
  } else {
    hn::StoreU(upsampled.first, d, to);
    hn::StoreU(upsampled.second, d, to + 3);
  }
}

template <class Method>
HWY_INLINE void upsample_across_by(const Method& method, const float* row, std::size_t count, float* fine) {
  constexpr std::size_t kLanes = hn::MaxLanes(Tag()), kPixels = kLanes / 3, kBorder = 3 * kUpsamplingStencil;
  const RowsAround around{row - 6, row - 3, row, row + 3, row + 6};
  std::size_t k = kBorder;
  if constexpr (kPixels > 0) {
    for (; k + kLanes + kBorder <= count; k += 3 * kPixels)
      store_side_by_side(Tag(), method(Tag(), around, k), fine + 2 * k);
  }
  for (; k + kBorder < count; ++k) {
    const auto upsampled = method(One(), around, k);
    float* const to = fine + 2 * (k - k % 3) + k % 3;
    hn::StoreU(upsampled.first, One(), to);
    hn::StoreU(upsampled.second, One(), to + 3);
  }
}

void halve_down(Upsampling how, const RowsAround& rows, std::size_t count, float* upper, float* lower) {
  if (how == Upsampling::Smooth) return halve_down_by(Smooth(), rows, count, upper, lower);
  halve_down_by(Interpolating(), rows, count, upper, lower);
}

void upsample_across(Upsampling how, const float* row, std::size_t count, float* fine) {
  if (how == Upsampling::Smooth) return upsample_across_by(Smooth(), row, count, fine);
  upsample_across_by(Interpolating(), row, count, fine);
}

}  // namespace contrejour::inline internal::area::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::area {

HWY_EXPORT(halve_down);
HWY_EXPORT(upsample_across);

void halve_down(Upsampling how, const RowsAround& rows, std::size_t count, float* upper, float* lower) {
  HWY_DYNAMIC_DISPATCH(halve_down)(how, rows, count, upper, lower);
}

void upsample_across(Upsampling how, const float* row, std::size_t count, float* fine) {
  HWY_DYNAMIC_DISPATCH(upsample_across)(how, row, count, fine);
}

}  // namespace contrejour::inline internal::area
#endif  // HWY_ONCE
