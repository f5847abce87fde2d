// SPDX-License-Identifier: Apache-2.0
#include "measure/playback/ghost_row.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "measure/playback/ghost_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using One = hn::CappedTag<float, 1>;

constexpr int kSamples = 5;  // of each cubic
constexpr int kNewtonSteps = 4;
constexpr float kMaxStep = 0.2F;       // of t, which samples leave uncertain by 0.1
constexpr float kCentre = 1e-9F;  // of rho, below which there is no direction
constexpr float kMinPower = 1e-20F;  // of a base whose logarithm is taken

// One coordinate of a cubic that may differ from lane to lane.
template <class D>
struct Cubic {
  hn::Vec<D> c0, c1, c2, c3;

  HWY_INLINE hn::Vec<D> at(hn::Vec<D> t) const { return hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, t, c2), t, c1), t, c0); }
};

template <class D>
HWY_INLINE Cubic<D> cubic_of(D d, const std::array<float, 4>& c) {
  return {hn::Set(d, c[0]), hn::Set(d, c[1]), hn::Set(d, c[2]), hn::Set(d, c[3])};
}

// A guess of the nearest point: the nearest of a few samples of both cubics.
template <class D>
struct Guess {
  hn::Vec<D> t, squared, is_right;  // is_right: 1 or 0
};

template <class D>
HWY_INLINE void consider_samples(D d, const std::array<float, 4>& cx, const std::array<float, 4>& cy, float is_right,
                                 hn::Vec<D> px, hn::Vec<D> py, Guess<D>& best) {
  for (int k = 0; k < kSamples; ++k) {
    const float t = (static_cast<float>(k) + 0.5F) / kSamples;
    const auto x = hn::Sub(hn::Set(d, ((cx[3] * t + cx[2]) * t + cx[1]) * t + cx[0]), px);
    const auto y = hn::Sub(hn::Set(d, ((cy[3] * t + cy[2]) * t + cy[1]) * t + cy[0]), py);
    const auto squared = hn::MulAdd(x, x, hn::Mul(y, y));
    const auto is_nearer = hn::Lt(squared, best.squared);
    best.t = hn::IfThenElse(is_nearer, hn::Set(d, t), best.t);
    best.is_right = hn::IfThenElse(is_nearer, hn::Set(d, is_right), best.is_right);
    best.squared = hn::Min(squared, best.squared);
  }
}

template <class D>
struct Nearest {
  hn::Vec<D> t, squared, side;  // side: above 0 outside
};

// Newton's steps from t, with a lower bound of the curvature where the distance has none.
template <class D>
HWY_INLINE Nearest<D> refined(D d, const Cubic<D>& cx, const Cubic<D>& cy, hn::Vec<D> px, hn::Vec<D> py, hn::Vec<D> t) {
  const auto max_step = hn::Set(d, kMaxStep), quarter = hn::Set(d, 0.25F), smallest = hn::Set(d, 1e-12F);
  const auto two = hn::Set(d, 2.0F), three = hn::Set(d, 3.0F), six = hn::Set(d, 6.0F);
  const auto x2 = hn::Mul(two, cx.c2), x3 = hn::Mul(three, cx.c3), y2 = hn::Mul(two, cy.c2), y3 = hn::Mul(three, cy.c3);
  const auto x6 = hn::Mul(six, cx.c3), y6 = hn::Mul(six, cy.c3);
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto x = hn::Sub(cx.at(t), px), y = hn::Sub(cy.at(t), py);
    const auto x1 = hn::MulAdd(hn::MulAdd(x3, t, x2), t, cx.c1), y1 = hn::MulAdd(hn::MulAdd(y3, t, y2), t, cy.c1);
    const auto slope = hn::MulAdd(x, x1, hn::Mul(y, y1));
    const auto speed = hn::MulAdd(x1, x1, hn::Mul(y1, y1));
    const auto bend = hn::MulAdd(x, hn::MulAdd(x6, t, x2), hn::Mul(y, hn::MulAdd(y6, t, y2)));
    const auto curvature = hn::Max(hn::Add(speed, bend), hn::MulAdd(quarter, speed, smallest));
    const auto step = hn::Max(hn::Min(hn::Div(slope, curvature), max_step), hn::Neg(max_step));
    t = hn::Max(hn::Min(hn::Sub(t, step), hn::Set(d, 1.0F)), hn::Zero(d));
  }
  const auto x = hn::Sub(px, cx.at(t)), y = hn::Sub(py, cy.at(t));
  const auto x1 = hn::MulAdd(hn::MulAdd(x3, t, x2), t, cx.c1), y1 = hn::MulAdd(hn::MulAdd(y3, t, y2), t, cy.c1);
  return {t, hn::MulAdd(x, x, hn::Mul(y, y)), hn::Sub(hn::Mul(y, x1), hn::Mul(x, y1))};
}

template <class D, class M>
HWY_INLINE Cubic<D> chosen(M is_right, const Cubic<D>& right, const Cubic<D>& left) {
  return {hn::IfThenElse(is_right, right.c0, left.c0), hn::IfThenElse(is_right, right.c1, left.c1),
          hn::IfThenElse(is_right, right.c2, left.c2), hn::IfThenElse(is_right, right.c3, left.c3)};
}

// The cubic with the nearest sample is refined. Where that ends at the top, which both cubics share, the nearest point
// may be on the other one, near its end.
template <class D>
HWY_INLINE hn::Vec<D> distance_at(D d, const GhostPacket& ghost, hn::Vec<D> x, hn::Vec<D> y) {
  const auto above = hn::Abs(y), half = hn::Set(d, 0.5F), one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  Guess<D> guess{half, hn::Set(d, 1e30F), zero};
  consider_samples(d, ghost.x[0], ghost.y[0], 0.0F, x, above, guess);
  consider_samples(d, ghost.x[1], ghost.y[1], 1.0F, x, above, guess);
  const auto is_right = hn::Gt(guess.is_right, half);
  const auto left_x = cubic_of(d, ghost.x[0]), left_y = cubic_of(d, ghost.y[0]);
  const auto right_x = cubic_of(d, ghost.x[1]), right_y = cubic_of(d, ghost.y[1]);
  auto nearest =
      refined(d, chosen<D>(is_right, right_x, left_x), chosen<D>(is_right, right_y, left_y), x, above, guess.t);
  const auto at_top = hn::Eq(nearest.t, hn::IfThenElse(is_right, zero, one));
  if (!hn::AllFalse(d, at_top)) {
    const auto start = hn::IfThenElse(is_right, hn::Set(d, 0.95F), hn::Set(d, 0.05F));
    const auto other =
        refined(d, chosen<D>(is_right, left_x, right_x), chosen<D>(is_right, left_y, right_y), x, above, start);
    const auto is_nearer = hn::And(at_top, hn::Lt(other.squared, nearest.squared));
    nearest.squared = hn::IfThenElse(is_nearer, other.squared, nearest.squared);
    nearest.side = hn::IfThenElse(is_nearer, other.side, nearest.side);
  }
  const auto size = hn::Sqrt(nearest.squared);
  const auto distance = hn::IfThenElse(hn::Lt(nearest.side, zero), hn::Neg(size), size);
  if (!(ghost.clip_radius > 0.0F)) return distance;
  const auto from_x = hn::Sub(x, hn::Set(d, ghost.clip_x));
  const auto from_clip = hn::Sqrt(hn::MulAdd(from_x, from_x, hn::Mul(y, y)));
  return hn::Max(distance, hn::Sub(from_clip, hn::Set(d, ghost.clip_radius)));
}

template <class D>
HWY_INLINE hn::Vec<D> power(D d, hn::Vec<D> base, float exponent) {
  const auto kept = hn::Max(base, hn::Set(d, kMinPower));
  const auto value = hn::Exp(d, hn::Mul(hn::Set(d, exponent), hn::Log(d, kept)));
  return hn::IfThenElse(hn::Gt(base, hn::Set(d, kMinPower)), value, hn::Zero(d));
}

// The border's weight integrated from low to high on its inner side, and likewise on its outer side: differences of the
// integrals in ghost_shade.cpp. x: distances from the border, not above 0 inside and not below 0 outside.
template <class D>
HWY_INLINE hn::Vec<D> between(D d, float fade, float slope, hn::Vec<D> near, hn::Vec<D> far) {
  const auto one = hn::Set(d, 1.0F), per_fade = hn::Set(d, fade > 0.0F ? 1.0F / fade : 1e30F);
  const auto rest = [&](hn::Vec<D> x) HWY_ATTR {
    return power(d, hn::Max(hn::NegMulAdd(x, per_fade, one), hn::Zero(d)), slope + 1.0F);
  };
  return hn::Mul(hn::Set(d, fade / (slope + 1.0F)), hn::Sub(rest(near), rest(far)));
}

template <class D>
struct Levels {
  hn::Vec<D> red, green, blue;
};

// The levels inside a ghost at packets of points.
template <class D>
HWY_INLINE Levels<D> inside_levels(D d, const GhostPacket& g, hn::Vec<D> x, hn::Vec<D> y) {
  Levels<D> levels{hn::Set(d, g.inside[0]), hn::Set(d, g.inside[1]), hn::Set(d, g.inside[2])};
  if (!g.has_profile) return levels;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const auto u = hn::Mul(x, hn::IfThenElse(hn::Lt(x, zero), hn::Set(d, g.per_left), hn::Set(d, g.per_right)));
  const auto v = hn::Mul(y, hn::Set(d, g.per_height));
  const auto rho = hn::Sqrt(hn::MulAdd(u, u, hn::Mul(v, v)));
  const auto c1 = hn::Div(u, hn::Max(rho, hn::Set(d, kCentre)));
  const auto c2 = hn::MulSub(hn::Add(c1, c1), c1, one);
  const auto at = hn::Mul(hn::Min(rho, one), hn::Set(d, static_cast<float>(kProfileRings - 1)));
  const auto add = [&](std::size_t c, std::size_t ring, hn::Vec<D> hat, hn::Vec<D> to) HWY_ATTR {
    const std::array<float, kProfileTerms>& p = g.profile[c];
    auto level = hn::Set(d, p[profile_index({0, ring})]);
    if (ring > 0) {
      level = hn::MulAdd(hn::Set(d, p[profile_index({1, ring})]), c1, level);
      level = hn::MulAdd(hn::Set(d, p[profile_index({2, ring})]), c2, level);
    }
    return hn::MulAdd(hat, level, to);
  };
  for (std::size_t ring = 0; ring < kProfileRings; ++ring) {
    const auto hat = hn::Max(zero, hn::Sub(one, hn::Abs(hn::Sub(at, hn::Set(d, static_cast<float>(ring))))));
    levels.red = add(0, ring, hat, levels.red);
    levels.green = add(1, ring, hat, levels.green);
    levels.blue = add(2, ring, hat, levels.blue);
  }
  return {hn::Max(levels.red, zero), hn::Max(levels.green, zero), hn::Max(levels.blue, zero)};
}

// Adds the levels of pixels with these weights.
template <class D>
HWY_INLINE void add_levels(D d, const GhostPacket& g, hn::Vec<D> border, hn::Vec<D> inside, const Levels<D>& level,
                           float* rgb) {
  if constexpr (hn::MaxLanes(D()) == 1) {
    const std::array<float, 3> inner{hn::GetLane(level.red), hn::GetLane(level.green), hn::GetLane(level.blue)};
    for (std::size_t c = 0; c < 3; ++c) {
      rgb[c] += g.border[c] * hn::GetLane(border) + inner[c] * hn::GetLane(inside);
    }
  } else {
    hn::Vec<D> red, green, blue;
    hn::LoadInterleaved3(d, rgb, red, green, blue);
    const auto add = [&](hn::Vec<D> to, std::size_t c, hn::Vec<D> inner) HWY_ATTR {
      return hn::MulAdd(hn::Set(d, g.border[c]), border, hn::MulAdd(inner, inside, to));
    };
    hn::StoreInterleaved3(add(red, 0, level.red), add(green, 1, level.green), add(blue, 2, level.blue), d, rgb);
  }
}

template <class D>
HWY_INLINE void add_packet(D d, const GhostPacket& g, hn::Vec<D> x, hn::Vec<D> y, float* rgb) {
  const auto distance = distance_at(d, g, x, y);
  const auto half = hn::Set(d, 0.5F), zero = hn::Zero(d);
  const auto low = hn::Sub(distance, half), high = hn::Add(distance, half);
  auto border = zero, inside = zero;
  if (!hn::AllTrue(d, hn::Ge(low, zero))) {  // a part of some pixel is inside
    const auto far = hn::Neg(hn::Min(low, zero)), near = hn::Neg(hn::Min(high, zero));
    border = between(d, g.fade_in, g.slope_in, near, far);
    inside = hn::Sub(hn::Sub(far, near), border);
  }
  if (!hn::AllTrue(d, hn::Le(high, zero))) {
    border = hn::Add(border, between(d, g.fade_out, g.slope_out, hn::Max(low, zero), hn::Max(high, zero)));
  }
  add_levels(d, g, border, inside, inside_levels(d, g, x, y), rgb);
}

// Calls act(d, x, y, k) for packets of points, from the k-th on.
template <class Act>
HWY_INLINE void for_each_packet(const PixelLine& line, std::size_t count, const Act& act) {
  const auto run = [&](auto d, std::size_t k) HWY_ATTR {
    const auto at = hn::Iota(d, static_cast<float>(k));
    act(d, hn::MulAdd(at, hn::Set(d, line.step_x), hn::Set(d, line.x)),
        hn::MulAdd(at, hn::Set(d, line.step_y), hn::Set(d, line.y)), k);
  };
  std::size_t k = 0;
  for (; k + hn::Lanes(Tag()) <= count; k += hn::Lanes(Tag())) run(Tag(), k);
  for (; k < count; ++k) run(One(), k);
}

void distances_of(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* distances) {
  for_each_packet(line, count, [&](auto d, auto x, auto y, std::size_t k) HWY_ATTR {
    hn::StoreU(distance_at(d, ghost, x, y), d, distances + k);
  });
}

void add_line(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* rgb) {
  for_each_packet(line, count,
                  [&](auto d, auto x, auto y, std::size_t k) HWY_ATTR { add_packet(d, ghost, x, y, rgb + 3 * k); });
}

void add_inside_line(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* rgb) {
  for_each_packet(line, count, [&](auto d, auto x, auto y, std::size_t k) HWY_ATTR {
    add_levels(d, ghost, hn::Zero(d), hn::Set(d, 1.0F), inside_levels(d, ghost, x, y), rgb + 3 * k);
  });
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {

HWY_EXPORT(distances_of);
HWY_EXPORT(add_line);
HWY_EXPORT(add_inside_line);

void ghost_distances(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* distances) {
  HWY_DYNAMIC_DISPATCH(distances_of)(ghost, line, count, distances);
}

void add_ghost(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* rgb) {
  HWY_DYNAMIC_DISPATCH(add_line)(ghost, line, count, rgb);
}

void add_inside(const GhostPacket& ghost, const PixelLine& line, std::size_t count, float* rgb) {
  HWY_DYNAMIC_DISPATCH(add_inside_line)(ghost, line, count, rgb);
}

}  // namespace contrejour::inline internal
#endif
