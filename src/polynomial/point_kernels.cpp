// SPDX-License-Identifier: Apache-2.0
#include "polynomial/point_kernels.h"

#include <algorithm>
#include <array>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "polynomial/point_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/inline_if_fast.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::polynomial::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kMaxLanes = 16;
using Tag = hn::CappedTag<float, kMaxLanes>;
using Vec = hn::Vec<Tag>;

// Points that are evaluated together: one vector of them, or two, for which coefficients are loaded once.
struct OneVector {
  static constexpr std::size_t kVectors = 1;
  Vec a;

  template <class Operation>
  HWY_INLINE OneVector with(const OneVector& y, const OneVector& z, const Operation& operation) const {
    return {operation(a, y.a, z.a)};
  }
  template <class Operation>
  HWY_INLINE void each(const Operation& operation) const {
    operation(a, 0);
  }
  static HWY_INLINE OneVector all(float value) { return {hn::Set(Tag(), value)}; }
};
struct TwoVectors {
  static constexpr std::size_t kVectors = 2;
  Vec a, b;

  template <class Operation>
  HWY_INLINE TwoVectors with(const TwoVectors& y, const TwoVectors& z, const Operation& operation) const {
    return {operation(a, y.a, z.a), operation(b, y.b, z.b)};
  }
  template <class Operation>
  HWY_INLINE void each(const Operation& operation) const {
    operation(a, 0);
    operation(b, 1);
  }
  static HWY_INLINE TwoVectors all(float value) { return {hn::Set(Tag(), value), hn::Set(Tag(), value)}; }
};

template <class Points>
HWY_INLINE Points mul_add(const Points& x, const Points& y, const Points& z) {
  return x.with(y, z, [](Vec p, Vec q, Vec r) HWY_ATTR { return hn::MulAdd(p, q, r); });
}
template <class Points>
HWY_INLINE Points mul(const Points& x, const Points& y) {
  return x.with(y, y, [](Vec p, Vec q, Vec /*unused*/) HWY_ATTR { return hn::Mul(p, q); });
}
template <class Points>
HWY_INLINE Points max(const Points& x, const Points& y) {
  return x.with(y, y, [](Vec p, Vec q, Vec /*unused*/) HWY_ATTR { return hn::Max(p, q); });
}

// The sum over w^k, k >= kK, of the terms with v^kJ.
template <int kDegree, int kJ, int kK, class Points>
HWY_INLINE Points sum_over_w(const float* c, const Points& w) {
  const Points here = Points::all(c[power_index(kJ, kK)]);
  if constexpr (kJ + kK == kDegree)
    return here;
  else
    return mul_add(sum_over_w<kDegree, kJ, kK + 1>(c, w), w, here);
}

template <int kDegree, int kJ, class Points>
CONTREJOUR_INLINE_IF_FAST Points sum_over_v(const float* c, const Points& v, const Points& w) {
  const Points here = sum_over_w<kDegree, kJ, 0>(c, w);
  if constexpr (kJ == kDegree)
    return here;
  else
    return mul_add(sum_over_v<kDegree, kJ + 1>(c, v, w), v, here);
}

// Degrees that only lenses without axial symmetry need.
template <class Points>
HWY_INLINE Points sum_of_any_degree(const float* c, int degree, const Points& v, const Points& w) {
  Points sum = Points::all(c[power_index(degree, 0)]);
  for (int j = degree - 1; j >= 0; --j) {
    Points over_w = Points::all(c[power_index(j, degree - j)]);
    for (int k = degree - j - 1; k >= 0; --k) over_w = mul_add(over_w, w, Points::all(c[power_index(j, k)]));
    sum = mul_add(sum, v, over_w);
  }
  return sum;
}

template <class Points>
CONTREJOUR_INLINE_IF_FAST Points value_of(const PowerSum& sum, const Points& v, const Points& w) {
  const float* const c = sum.coefficients.data();
  switch (sum.degree) {
    case 0: return sum_over_v<0, 0>(c, v, w);
    case 1: return sum_over_v<1, 0>(c, v, w);
    case 2: return sum_over_v<2, 0>(c, v, w);
    case 3: return sum_over_v<3, 0>(c, v, w);
    case 4: return sum_over_v<4, 0>(c, v, w);
    case 5: return sum_over_v<5, 0>(c, v, w);
    case 6: return sum_over_v<6, 0>(c, v, w);
    case 7: return sum_over_v<7, 0>(c, v, w);
    case 8: return sum_over_v<8, 0>(c, v, w);
    default: return sum_of_any_degree(c, sum.degree, v, w);
  }
}
static_assert(kMaxDegree == 8);

// 1 - 2 sqrt(1 - squared per_end), 1 beyond the end.
template <class Points>
HWY_INLINE Points to_pupil_end(const Points& squared, float per_end) {
  const Points left = max(mul_add(squared, Points::all(-per_end), Points::all(1.0F)), Points::all(0.0F));
  const Points root = left.with(left, left, [](Vec p, Vec, Vec) HWY_ATTR { return hn::Sqrt(p); });
  return mul_add(root, Points::all(-2.0F), Points::all(1.0F));
}

// Writes `count` of the points, which are all of them but for the last vector.
template <class Points>
HWY_INLINE void store(const Points& values, float* to, std::size_t count) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  values.each([&](Vec vector, std::size_t k) HWY_ATTR {
    if (count >= Points::kVectors * lanes) {
      hn::StoreU(vector, d, to + k * lanes);
      return;
    }
    HWY_ALIGN std::array<float, kMaxLanes> part;
    hn::Store(vector, d, part.data());
    std::copy_n(part.data(), count, to);
  });
}

// The points that start at one of them; `count` of them are written.
template <class Points>
CONTREJOUR_INLINE_IF_FAST void evaluate_from(const PupilMap& map, const Points& x_mm, const Points& y_mm,
                                             std::size_t at, std::size_t count, const PointOutputs& out) {
  const Points per_mm = Points::all(map.per_mm), h = Points::all(map.h);
  const Points px = mul_add(x_mm, per_mm, Points::all(map.x));
  const Points py = mul_add(y_mm, map.symmetric ? per_mm : Points::all(map.y_per_mm), Points::all(map.y));
  const Points v = map.symmetric ? mul(h, px) : px;
  const Points squared = mul_add(px, px, mul(py, py));
  const Points w = map.symmetric ? mul_add(squared, Points::all(2.0F), Points::all(-1.0F)) : py;
  const Points w_of_light = map.per_end > 0.0F ? to_pupil_end(squared, map.per_end) : w;
  Points highest = Points::all(0.0F);
  const Points scale = Points::all(out.stop_scale * out.stop_scale);
  for (std::size_t k = 0; k < out.vectors.size(); ++k) {
    const VectorOutput& vector = out.vectors[k];
    const bool is_stop = k + out.crossings >= out.vectors.size();
    const Points& here = is_stop ? w : w_of_light;
    const Points along_pupil = value_of(*vector.along_pupil, v, here);
    const Points along_field = value_of(*vector.along_field, v, here);
    const Points x = map.symmetric ? mul_add(px, along_pupil, mul(h, along_field)) : along_field;
    const Points y = map.symmetric ? mul(py, along_pupil) : along_pupil;
    store(x, vector.x + at, count);
    store(y, vector.y + at, count);
    if (is_stop) highest = max(highest, mul(scale, mul_add(x, x, mul(y, y))));
  }
  for (const ScalarOutput& rim : out.rims) {
    const Points height = value_of(*rim.sum, v, w);
    if (rim.values != nullptr) store(height, rim.values + at, count);
    highest = max(highest, height);
  }
  if (out.relative_height != nullptr)
    store(highest.with(highest, highest, [](Vec p, Vec, Vec) HWY_ATTR { return hn::Sqrt(p); }),
          out.relative_height + at, count);
  if (out.transmittance.values == nullptr) return;
  const Points limit = Points::all(out.largest_transmittance);
  const Points light = max(value_of(*out.transmittance.sum, v, w_of_light), Points::all(0.0F));
  store(light.with(limit, limit, [](Vec p, Vec q, Vec) HWY_ATTR { return hn::Min(p, q); }),
        out.transmittance.values + at, count);
}

void evaluate_all(const PupilMap& map, const float* x_mm, const float* y_mm, std::size_t count,
                  const PointOutputs& out) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  const auto at_vector = [&](const float* from) HWY_ATTR { return hn::LoadU(d, from); };
  std::size_t at = 0;
  for (; at + 2 * lanes <= count; at += 2 * lanes)
    evaluate_from(map, TwoVectors{at_vector(x_mm + at), at_vector(x_mm + at + lanes)},
                  TwoVectors{at_vector(y_mm + at), at_vector(y_mm + at + lanes)}, at, 2 * lanes, out);
  for (; at + lanes <= count; at += lanes)
    evaluate_from(map, OneVector{at_vector(x_mm + at)}, OneVector{at_vector(y_mm + at)}, at, lanes, out);
  if (at == count) return;
  std::array<float, kMaxLanes> x{}, y{};
  std::copy_n(x_mm + at, count - at, x.data());
  std::copy_n(y_mm + at, count - at, y.data());
  evaluate_from(map, OneVector{at_vector(x.data())}, OneVector{at_vector(y.data())}, at, count - at, out);
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
