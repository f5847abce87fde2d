// SPDX-License-Identifier: Apache-2.0
// Four numbers, the three channels of a pixel and an unused one, in as many vectors as they need.
#if defined(CONTREJOUR_ADAPTIVE_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_QUAD_INL_H_
#undef CONTREJOUR_ADAPTIVE_QUAD_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_QUAD_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kQuad = 4;

template <class T>
struct QuadOf {
  using Tag = hn::CappedTag<T, kQuad>;
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag()), kParts = kQuad / kLanes;
  hn::Vec<Tag> part[kParts];

  static HWY_INLINE QuadOf load(const T* from) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::LoadU(Tag(), from + p * kLanes); });
  }
  static HWY_INLINE QuadOf all(T value) {
    return made_of([&](std::size_t) HWY_ATTR { return hn::Set(Tag(), value); });
  }
  HWY_INLINE void store(T* to) const {
    for (std::size_t p = 0; p < kParts; ++p) hn::StoreU(part[p], Tag(), to + p * kLanes);
  }
  template <int kLane>
  [[nodiscard]] HWY_INLINE QuadOf broadcast() const {
    return made_of([&](std::size_t) HWY_ATTR {
      return hn::Broadcast<kLane % static_cast<int>(kLanes)>(part[kLane / static_cast<int>(kLanes)]);
    });
  }
  friend HWY_INLINE QuadOf operator*(QuadOf a, QuadOf b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Mul(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE QuadOf operator+(QuadOf a, QuadOf b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Add(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE QuadOf operator-(QuadOf a, QuadOf b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Sub(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE QuadOf multiply_add(QuadOf a, QuadOf b, QuadOf c) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::MulAdd(a.part[p], b.part[p], c.part[p]); });
  }

 private:
  template <class PartOf>
  static HWY_INLINE QuadOf made_of(const PartOf& part_of) {
    QuadOf out;
    for (std::size_t p = 0; p < kParts; ++p) out.part[p] = part_of(p);
    return out;
  }
};

using Quad = QuadOf<float>;
using DoubleQuad = QuadOf<double>;

// Interpolates linearly between a and b.
HWY_INLINE Quad mix(Quad a, Quad b, Quad t) { return multiply_add(t, b - a, a); }

HWY_INLINE DoubleQuad to_doubles(const float* from) {
  const DoubleQuad::Tag d;
  const hn::Rebind<float, DoubleQuad::Tag> df;
  DoubleQuad out;
  for (std::size_t p = 0; p < DoubleQuad::kParts; ++p)
    out.part[p] = hn::PromoteTo(d, hn::LoadU(df, from + p * DoubleQuad::kLanes));
  return out;
}

template <class Doubles>
HWY_INLINE Quad to_floats(const Doubles& q) {
  static_assert(std::is_same_v<Doubles, DoubleQuad>);
  const auto part = [&](std::size_t p)
                        HWY_ATTR { return hn::DemoteTo(hn::Rebind<float, typename Doubles::Tag>(), q.part[p]); };
  Quad out;
  if constexpr (Doubles::kParts == Quad::kParts) {
    for (std::size_t p = 0; p < Quad::kParts; ++p) out.part[p] = part(p);
  } else {
    out.part[0] = Combine(Quad::Tag(), part(1), part(0));  // found by its arguments' types: scalar targets lack it
  }
  return out;
}

// Four numbers, each linear along a row.
template <class T>
struct QuadLine {
  QuadOf<T> level, slope;

  static HWY_INLINE QuadLine zero() { return {QuadOf<T>::all(T{0}), QuadOf<T>::all(T{0})}; }
  static HWY_INLINE QuadLine load(const T* from) { return {QuadOf<T>::load(from), QuadOf<T>::load(from + kQuad)}; }
  HWY_INLINE void store(T* to) const {
    level.store(to);
    slope.store(to + kQuad);
  }
  [[nodiscard]] HWY_INLINE QuadOf<T> at(T x) const { return multiply_add(slope, QuadOf<T>::all(x), level); }
  friend HWY_INLINE QuadLine operator+(const QuadLine& a, const QuadLine& b) {
    return {a.level + b.level, a.slope + b.slope};
  }
  friend HWY_INLINE QuadLine operator-(const QuadLine& a, const QuadLine& b) {
    return {a.level - b.level, a.slope - b.slope};
  }
  // a + times * b
  friend HWY_INLINE QuadLine add_times(const QuadLine& a, const QuadLine& b, T times) {
    const auto all = QuadOf<T>::all(times);
    return {multiply_add(b.level, all, a.level), multiply_add(b.slope, all, a.slope)};
  }
};

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
