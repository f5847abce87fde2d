// Four floats, a pixel's channels, side by side in one vector where there are vectors.
#if defined(CONTREJOUR_ADAPTIVE_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_QUAD_INL_H_
#undef CONTREJOUR_ADAPTIVE_QUAD_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_QUAD_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

struct Quad {
  float v[4];

  static Quad load(const float* from) { return {{from[0], from[1], from[2], from[3]}}; }
  static Quad all(float value) { return {{value, value, value, value}}; }
  void store(float* to) const {
    for (int k = 0; k < 4; ++k) to[k] = v[k];
  }
  template <int kLane>
  [[nodiscard]] Quad broadcast() const {
    return all(v[kLane]);
  }
  friend Quad operator*(Quad a, Quad b) { return multiply_add(a, b, all(0.0F)); }
  friend Quad operator+(Quad a, Quad b) { return multiply_add(b, all(1.0F), a); }
  friend Quad operator-(Quad a, Quad b) { return multiply_add(b, all(-1.0F), a); }
  friend Quad multiply_add(Quad a, Quad b, Quad c) {
    for (int k = 0; k < 4; ++k) c.v[k] += a.v[k] * b.v[k];
    return c;
  }
};

#else

struct Quad {
  using Tag = hn::FixedTag<float, 4>;
  hn::Vec<Tag> v;

  static HWY_INLINE Quad load(const float* from) { return {hn::LoadU(Tag(), from)}; }
  static HWY_INLINE Quad all(float value) { return {hn::Set(Tag(), value)}; }
  HWY_INLINE void store(float* to) const { hn::StoreU(v, Tag(), to); }
  template <int kLane>
  [[nodiscard]] HWY_INLINE Quad broadcast() const {
    return {hn::Broadcast<kLane>(v)};
  }
  friend HWY_INLINE Quad operator*(Quad a, Quad b) { return {hn::Mul(a.v, b.v)}; }
  friend HWY_INLINE Quad operator+(Quad a, Quad b) { return {hn::Add(a.v, b.v)}; }
  friend HWY_INLINE Quad operator-(Quad a, Quad b) { return {hn::Sub(a.v, b.v)}; }
  friend HWY_INLINE Quad multiply_add(Quad a, Quad b, Quad c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
};

#endif

// From a to b, t of the way.
HWY_INLINE Quad mix(Quad a, Quad b, Quad t) { return multiply_add(t, b - a, a); }

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
