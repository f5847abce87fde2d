// SPDX-License-Identifier: Apache-2.0
#include "polynomial/point_kernels.h"

#include <algorithm>
#include <array>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "polynomial/point_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::polynomial::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kMaxLanes = 16;
using Tag = hn::CappedTag<float, kMaxLanes>;
using Packet = hn::Vec<Tag>;

// The sum over w^k, k >= kK, of the terms with v^kJ.
template <int kDegree, int kJ, int kK>
HWY_INLINE Packet sum_over_w(const float* c, Packet w) {
  const Packet here = hn::Set(Tag(), c[power_index(kJ, kK)]);
  if constexpr (kJ + kK == kDegree)
    return here;
  else
    return hn::MulAdd(sum_over_w<kDegree, kJ, kK + 1>(c, w), w, here);
}

template <int kDegree, int kJ = 0>
HWY_INLINE Packet sum_over_v(const float* c, Packet v, Packet w) {
  const Packet here = sum_over_w<kDegree, kJ, 0>(c, w);
  if constexpr (kJ == kDegree)
    return here;
  else
    return hn::MulAdd(sum_over_v<kDegree, kJ + 1>(c, v, w), v, here);
}

HWY_INLINE Packet value_of(const PowerSum& sum, Packet v, Packet w) {
  const float* const c = sum.coefficients.data();
  switch (sum.degree) {
    case 0: return sum_over_v<0>(c, v, w);
    case 1: return sum_over_v<1>(c, v, w);
    case 2: return sum_over_v<2>(c, v, w);
    case 3: return sum_over_v<3>(c, v, w);
    case 4: return sum_over_v<4>(c, v, w);
    case 5: return sum_over_v<5>(c, v, w);
    default: return sum_over_v<6>(c, v, w);
  }
}
static_assert(kMaxDegree == 6);

// The packet that starts at a point; `count` points of it are written.
HWY_INLINE void evaluate_packet(const PupilMap& map, Packet x_mm, Packet y_mm, std::size_t at, std::size_t count,
                                const PointOutputs& out) {
  const Tag d;
  const auto store = [&](Packet values, float* to) HWY_ATTR {
    if (count == hn::Lanes(d)) {
      hn::StoreU(values, d, to + at);
      return;
    }
    HWY_ALIGN std::array<float, kMaxLanes> part;
    hn::Store(values, d, part.data());
    std::copy_n(part.data(), count, to + at);
  };
  const Packet per_mm = hn::Set(d, map.per_mm), h = hn::Set(d, map.h), one = hn::Set(d, 1.0F);
  const Packet px = hn::MulAdd(x_mm, per_mm, hn::Set(d, map.x)), py = hn::MulAdd(y_mm, per_mm, hn::Set(d, map.y));
  const Packet v = hn::Mul(h, px);
  const Packet squared = hn::MulAdd(px, px, hn::Mul(py, py));
  const Packet w = hn::Sub(hn::Add(squared, squared), one);
  Packet highest = hn::Zero(d);
  const Packet scale = hn::Set(d, out.stop_scale * out.stop_scale);
  for (std::size_t k = 0; k < out.vectors.size(); ++k) {
    const VectorOutput& vector = out.vectors[k];
    const Packet along_pupil = value_of(*vector.along_pupil, v, w);
    const Packet x = hn::MulAdd(px, along_pupil, hn::Mul(h, value_of(*vector.along_field, v, w)));
    const Packet y = hn::Mul(py, along_pupil);
    store(x, vector.x);
    store(y, vector.y);
    if (k + out.crossings >= out.vectors.size())
      highest = hn::Max(highest, hn::Mul(scale, hn::MulAdd(x, x, hn::Mul(y, y))));
  }
  for (const ScalarOutput& rim : out.rims) {
    const Packet height = value_of(*rim.sum, v, w);
    if (rim.values != nullptr) store(height, rim.values);
    highest = hn::Max(highest, height);
  }
  if (out.relative_height != nullptr) store(hn::Sqrt(highest), out.relative_height);
  if (out.transmittance.values != nullptr)
    store(hn::Min(hn::Max(value_of(*out.transmittance.sum, v, w), hn::Zero(d)), hn::Set(d, out.largest_transmittance)),
          out.transmittance.values);
}

void evaluate_all(const PupilMap& map, const float* x_mm, const float* y_mm, std::size_t count,
                  const PointOutputs& out) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t at = 0;
  for (; at + lanes <= count; at += lanes)
    evaluate_packet(map, hn::LoadU(d, x_mm + at), hn::LoadU(d, y_mm + at), at, lanes, out);
  if (at == count) return;
  HWY_ALIGN std::array<float, kMaxLanes> x{}, y{};
  std::copy_n(x_mm + at, count - at, x.data());
  std::copy_n(y_mm + at, count - at, y.data());
  evaluate_packet(map, hn::Load(d, x.data()), hn::Load(d, y.data()), at, count - at, out);
}

}  // namespace contrejour::inline internal::polynomial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::polynomial {
namespace {

HWY_EXPORT(evaluate_all);

}  // namespace

void evaluate_points(const PupilMap& map, const float* x_mm, const float* y_mm, std::size_t count,
                     const PointOutputs& out) {
  HWY_DYNAMIC_DISPATCH(evaluate_all)(map, x_mm, y_mm, count, out);
}

}  // namespace contrejour::inline internal::polynomial
#endif  // HWY_ONCE
