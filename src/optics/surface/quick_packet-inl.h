// SPDX-License-Identifier: Apache-2.0
// A packet of floats whose quotients and roots are the processor's estimates refined by one Newton step: accurate to
// about 1e-6, in a fraction of the time. It serves searches, whose results are traced again exactly.
#if defined(CONTREJOUR_KERNELS_QUICK_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_KERNELS_QUICK_PACKET_INL_H_
#undef CONTREJOUR_KERNELS_QUICK_PACKET_INL_H_
#else
#define CONTREJOUR_KERNELS_QUICK_PACKET_INL_H_
#endif

#include <hwy/highway.h>

#include "optics/surface/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

struct QuickPacket {
  using Tag = hn::ScalableTag<float>;
  using Vector = hn::Vec<Tag>;
  using Mask = hn::Mask<Tag>;

  Vector v;

  QuickPacket() = default;
  HWY_INLINE explicit QuickPacket(Vector value) : v(value) {}
  HWY_INLINE explicit QuickPacket(Packet<float> p) : v(p.v) {}
  HWY_INLINE explicit QuickPacket(double value) : v(hn::Set(Tag(), static_cast<float>(value))) {}

  friend HWY_INLINE QuickPacket operator+(QuickPacket a, QuickPacket b) { return QuickPacket(hn::Add(a.v, b.v)); }
  friend HWY_INLINE QuickPacket operator-(QuickPacket a, QuickPacket b) { return QuickPacket(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE QuickPacket operator*(QuickPacket a, QuickPacket b) { return QuickPacket(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Mask operator>(QuickPacket a, QuickPacket b) { return hn::Gt(a.v, b.v); }

  friend HWY_INLINE QuickPacket operator/(QuickPacket a, QuickPacket b) {
    const Vector y = hn::ApproximateReciprocal(b.v);
    return QuickPacket(hn::Mul(a.v, hn::Mul(y, hn::NegMulAdd(b.v, y, hn::Set(Tag(), 2.0F)))));
  }
  // The root of 0 is 1e-15, so that no quotient becomes infinite.
  friend HWY_INLINE QuickPacket square_root(QuickPacket a) {
    const Vector x = hn::Max(a.v, hn::Set(Tag(), 1e-30F));
    const Vector y = hn::ApproximateReciprocalSqrt(x);
    const Vector half_xy = hn::Mul(hn::Mul(hn::Set(Tag(), 0.5F), x), y);
    const Vector xy = hn::Add(half_xy, half_xy);
    return QuickPacket(hn::Mul(xy, hn::NegMulAdd(half_xy, y, hn::Set(Tag(), 1.5F))));
  }

  friend HWY_INLINE QuickPacket larger(QuickPacket a, QuickPacket b) { return QuickPacket(hn::Max(a.v, b.v)); }
  friend HWY_INLINE QuickPacket smaller(QuickPacket a, QuickPacket b) { return QuickPacket(hn::Min(a.v, b.v)); }
  friend HWY_INLINE QuickPacket select(Mask use_a, QuickPacket a, QuickPacket b) {
    return QuickPacket(hn::IfThenElse(use_a, a.v, b.v));
  }
};

HWY_INLINE void store_floats(QuickPacket p, float* to) { hn::StoreU(p.v, QuickPacket::Tag(), to); }

}  // namespace contrejour::inline internal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
