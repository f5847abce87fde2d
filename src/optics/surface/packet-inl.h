// SPDX-License-Identifier: Apache-2.0
// Several rays in a vector register with the operators of a number, so that the templates of surface-inl.h trace a
// packet with the formulas of the scalar tracer. Compiled once per instruction set (foreach_target).
#if defined(CONTREJOUR_KERNELS_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_KERNELS_PACKET_INL_H_
#undef CONTREJOUR_KERNELS_PACKET_INL_H_
#else
#define CONTREJOUR_KERNELS_PACKET_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "optics/surface/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Lane: float or double. Vectors of a size known only at run time (SVE, RVV) cannot be members of a struct;
// a file that uses packets disables those targets.
template <class Lane>
struct Packet {
  using Tag = hn::ScalableTag<Lane>;
  using Vector = hn::Vec<Tag>;
  using Mask = hn::Mask<Tag>;

  Vector v;

  Packet() = default;
  HWY_INLINE explicit Packet(Vector value) : v(value) {}
  HWY_INLINE explicit Packet(double value) : v(hn::Set(Tag(), static_cast<Lane>(value))) {}

  friend HWY_INLINE Packet operator+(Packet a, Packet b) { return Packet(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Packet operator-(Packet a, Packet b) { return Packet(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Packet operator*(Packet a, Packet b) { return Packet(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Packet operator/(Packet a, Packet b) { return Packet(hn::Div(a.v, b.v)); }
  friend HWY_INLINE Mask operator>(Packet a, Packet b) { return hn::Gt(a.v, b.v); }

  friend HWY_INLINE Packet square_root(Packet a) { return Packet(hn::Sqrt(a.v)); }
  friend HWY_INLINE Packet larger(Packet a, Packet b) { return Packet(hn::Max(a.v, b.v)); }
  friend HWY_INLINE Packet smaller(Packet a, Packet b) { return Packet(hn::Min(a.v, b.v)); }
  friend HWY_INLINE Packet select(Mask use_a, Packet a, Packet b) { return Packet(hn::IfThenElse(use_a, a.v, b.v)); }
  friend HWY_INLINE Packet or_zero(Mask use_a, Packet a) { return Packet(hn::IfThenElseZero(use_a, a.v)); }
};

// Samples are read and written as float whatever the lanes are.
HWY_INLINE Packet<float> load_floats(Packet<float>::Tag d, const float* from) {
  return Packet<float>(hn::LoadU(d, from));
}
HWY_INLINE void store_floats(Packet<float> p, float* to) { hn::StoreU(p.v, Packet<float>::Tag(), to); }

template <class Lane>
HWY_INLINE Packet<Lane> exponential(Packet<Lane> x) {
  return Packet<Lane>(hn::Exp(typename Packet<Lane>::Tag(), x.v));
}

// A function on [0, 1] tabulated at `intervals` + 1 equidistant points, interpolated linearly. u outside the interval,
// or NaN, is clamped to one of its ends.
HWY_INLINE Packet<float> look_up(const float* table, int intervals, Packet<float> u) {
  const Packet<float>::Tag d;
  const hn::RebindToSigned<Packet<float>::Tag> di;
  const Packet<float> scale(static_cast<double>(intervals));
  const Packet<float> position = smaller(or_zero(u > Packet<float>(0.0), u) * scale, scale);
  const auto index = hn::Min(hn::ConvertTo(di, position.v), hn::Set(di, intervals - 1));
  const auto low = hn::GatherIndex(d, table, index);
  const auto high = hn::GatherIndex(d, table + 1, index);
  return Packet<float>(hn::MulAdd(hn::Sub(position.v, hn::ConvertTo(d, index)), hn::Sub(high, low), low));
}

#if HWY_HAVE_FLOAT64
using FloatsOfDoubles = hn::Rebind<float, Packet<double>::Tag>;

HWY_INLINE Packet<double> load_floats(Packet<double>::Tag d, const float* from) {
  return Packet<double>(hn::PromoteTo(d, hn::LoadU(FloatsOfDoubles(), from)));
}
HWY_INLINE void store_floats(Packet<double> p, float* to) {
  const FloatsOfDoubles d;
  const auto narrow = hn::DemoteTo(d, p.v);
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128  // which make the largest float of infinity
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  hn::StoreU(hn::IfThenElse(hn::Ge(narrow, hn::Set(d, std::numeric_limits<float>::max())), infinite, narrow), d, to);
#else
  hn::StoreU(narrow, d, to);
#endif
}

HWY_INLINE Packet<double> look_up(const float* table, int intervals, Packet<double> u) {
  const FloatsOfDoubles d;
  const hn::RebindToSigned<FloatsOfDoubles> di;
  const Packet<double> scale(static_cast<double>(intervals));
  const Packet<double> position = smaller(or_zero(u > Packet<double>(0.0), u) * scale, scale);
  const auto index = hn::Min(hn::DemoteTo(di, position.v), hn::Set(di, intervals - 1));
  const auto low = hn::GatherIndex(d, table, index);
  const auto high = hn::GatherIndex(d, table + 1, index);
  const Packet<double> between = position - Packet<double>(hn::PromoteTo(Packet<double>::Tag(), index));
  const Packet<double> rise(hn::PromoteTo(Packet<double>::Tag(), hn::Sub(high, low)));
  return Packet<double>(hn::PromoteTo(Packet<double>::Tag(), low)) + between * rise;
}
using PrecisePacket = Packet<double>;
#else
using PrecisePacket = Packet<float>;  // used if an instruction set has no vectors of double (never on x86)
#endif

}  // namespace contrejour::inline internal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
