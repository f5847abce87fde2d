// SPDX-License-Identifier: Apache-2.0
// Four numbers, the three channels of a pixel and an unused one, in as many vectors as they need.
#if defined(CONTREJOUR_ADAPTIVE_CHANNEL_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_CHANNEL_VECTOR_INL_H_
#undef CONTREJOUR_ADAPTIVE_CHANNEL_VECTOR_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_CHANNEL_VECTOR_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kVectorChannels = 4;

template <class T>
struct ChannelVectorOf {
  using Tag = hn::CappedTag<T, kVectorChannels>;
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag()), kParts = kVectorChannels / kLanes;
  hn::Vec<Tag> part[kParts];

  static HWY_INLINE ChannelVectorOf load(const T* from) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::LoadU(Tag(), from + p * kLanes); });
  }
  static HWY_INLINE ChannelVectorOf all(T value) {
    return made_of([&](std::size_t) HWY_ATTR { return hn::Set(Tag(), value); });
  }
  HWY_INLINE void store(T* to) const {
    for (std::size_t p = 0; p < kParts; ++p) hn::StoreU(part[p], Tag(), to + p * kLanes);
  }
  template <int kLane>
  [[nodiscard]] HWY_INLINE ChannelVectorOf broadcast() const {
    return made_of([&](std::size_t) HWY_ATTR {
      return hn::Broadcast<kLane % static_cast<int>(kLanes)>(part[kLane / static_cast<int>(kLanes)]);
    });
  }
  friend HWY_INLINE ChannelVectorOf operator*(ChannelVectorOf a, ChannelVectorOf b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Mul(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE ChannelVectorOf operator+(ChannelVectorOf a, ChannelVectorOf b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Add(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE ChannelVectorOf operator-(ChannelVectorOf a, ChannelVectorOf b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Sub(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE ChannelVectorOf multiply_add(ChannelVectorOf a, ChannelVectorOf b, ChannelVectorOf c) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::MulAdd(a.part[p], b.part[p], c.part[p]); });
  }

 private:
  template <class PartOf>
  static HWY_INLINE ChannelVectorOf made_of(const PartOf& part_of) {
    ChannelVectorOf out;
    for (std::size_t p = 0; p < kParts; ++p) out.part[p] = part_of(p);
    return out;
  }
};

using ChannelVector = ChannelVectorOf<float>;
using DoubleChannelVector = ChannelVectorOf<double>;

// Interpolates linearly between a and b.
HWY_INLINE ChannelVector interpolate(ChannelVector a, ChannelVector b, ChannelVector t) {
  return multiply_add(t, b - a, a);
}

HWY_INLINE DoubleChannelVector to_doubles(const float* from) {
  const DoubleChannelVector::Tag d;
  const hn::Rebind<float, DoubleChannelVector::Tag> df;
  DoubleChannelVector out;
  for (std::size_t p = 0; p < DoubleChannelVector::kParts; ++p)
    out.part[p] = hn::PromoteTo(d, hn::LoadU(df, from + p * DoubleChannelVector::kLanes));
  return out;
}

template <class Doubles>
HWY_INLINE ChannelVector to_floats(const Doubles& q) {
  static_assert(std::is_same_v<Doubles, DoubleChannelVector>);
  const auto part = [&](std::size_t p)
                        HWY_ATTR { return hn::DemoteTo(hn::Rebind<float, typename Doubles::Tag>(), q.part[p]); };
  ChannelVector out;
  if constexpr (Doubles::kParts == ChannelVector::kParts) {
    for (std::size_t p = 0; p < ChannelVector::kParts; ++p) out.part[p] = part(p);
  } else {
    out.part[0] =
        Combine(ChannelVector::Tag(), part(1), part(0));  // found by its arguments' types: scalar targets lack it
  }
  return out;
}

// Four numbers, each linear along a row.
template <class T>
struct ChannelLine {
  ChannelVectorOf<T> level, slope;

  static HWY_INLINE ChannelLine zero() { return {ChannelVectorOf<T>::all(T{0}), ChannelVectorOf<T>::all(T{0})}; }
  static HWY_INLINE ChannelLine load(const T* from) {
    return {ChannelVectorOf<T>::load(from), ChannelVectorOf<T>::load(from + kVectorChannels)};
  }
  HWY_INLINE void store(T* to) const {
    level.store(to);
    slope.store(to + kVectorChannels);
  }
  [[nodiscard]] HWY_INLINE ChannelVectorOf<T> at(T x) const {
    return multiply_add(slope, ChannelVectorOf<T>::all(x), level);
  }
  friend HWY_INLINE ChannelLine operator+(const ChannelLine& a, const ChannelLine& b) {
    return {a.level + b.level, a.slope + b.slope};
  }
  friend HWY_INLINE ChannelLine operator-(const ChannelLine& a, const ChannelLine& b) {
    return {a.level - b.level, a.slope - b.slope};
  }
  // a + times * b
  friend HWY_INLINE ChannelLine add_times(const ChannelLine& a, const ChannelLine& b, T times) {
    const auto all = ChannelVectorOf<T>::all(times);
    return {multiply_add(b.level, all, a.level), multiply_add(b.slope, all, a.slope)};
  }
};

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
