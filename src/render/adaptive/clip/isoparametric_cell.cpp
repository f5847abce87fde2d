// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/clip/isoparametric_cell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/adaptive/clip/isoparametric_cell.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;  // points computed at once
using Points = hn::Vec<Tag>;
constexpr std::size_t kAtOnce = hn::MaxLanes(Tag());

// The shape functions of a cell's corners: linear in a triangle, bilinear in a cell of four corners, quadratic along
// the sides of one of eight (serendipity; Zienkiewicz and Taylor, The Finite Element Method).
struct CornerWeights {
  std::array<Points, IsoparametricCell::kCurvedCorners> of;

  HWY_INLINE CornerWeights(std::size_t corners, Points u, Points v) {
    const Tag d;
    const auto one = hn::Set(d, 1.0);
    const auto from_u = hn::Sub(one, u), from_v = hn::Sub(one, v);
    if (corners == 3) {
      of[0] = from_u, of[1] = hn::Sub(u, v), of[2] = v;
      return;
    }
    const std::array<Points, 4> s{hn::Mul(from_u, from_v), hn::Mul(u, from_v), hn::Mul(u, v), hn::Mul(from_u, v)};
    if (corners == 4) {
      for (std::size_t k = 0; k < 4; ++k) of[k] = s[k];
      return;
    }
    const auto four = hn::Set(d, 4.0), half = hn::Set(d, 0.5);
    const auto across_u = hn::Mul(four, hn::Mul(u, from_u)), across_v = hn::Mul(four, hn::Mul(v, from_v));
    const std::array<Points, 4> side{hn::Mul(across_u, from_v), hn::Mul(across_v, u), hn::Mul(across_u, v),
                                     hn::Mul(across_v, from_u)};
    for (std::size_t k = 0; k < 4; ++k) {
      of[2 * k] = hn::NegMulAdd(half, hn::Add(side[k], side[(k + 3) % 4]), s[k]);
      of[2 * k + 1] = side[k];
    }
  }
};

// Interpolates corners at several points at once.
class CornersAt {
 public:
  HWY_INLINE CornersAt(std::span<const Corner> cell, std::size_t limits, Points u, Points v) : limits_(limits) {
    const Tag d;
    const hn::Rebind<float, Tag> df;
    const CornerWeights weights(cell.size(), u, v);
    const auto sum = [&](const auto& value) HWY_ATTR {
      auto total = hn::Mul(weights.of[0], hn::Set(d, value(cell[0])));
      for (std::size_t k = 1; k < cell.size(); ++k)
        total = hn::MulAdd(weights.of[k], hn::Set(d, value(cell[k])), total);
      return total;
    };
    hn::Store(u, d, u_);
    hn::Store(v, d, v_);
    hn::Store(sum([](const Corner& c) { return c.position.x; }), d, x_);
    hn::Store(sum([](const Corner& c) { return c.position.y; }), d, y_);
    for (std::size_t l = 0; l < limits; ++l) {
      const auto value = sum([l](const Corner& c) { return static_cast<double>(c.limit[l]); });
      hn::Store(hn::DemoteTo(df, value), df, limit_[l]);
    }
  }
  [[nodiscard]] HWY_INLINE bool is_none(std::size_t k) const { return std::isnan(u_[k]); }
  [[nodiscard]] HWY_INLINE Corner operator[](std::size_t k) const {
    Corner corner{{x_[k], y_[k]}, {u_[k], v_[k]}, {}};
    for (std::size_t l = 0; l < limits_; ++l) corner.limit[l] = limit_[l][k];
    return corner;
  }

 private:
  std::size_t limits_;
  HWY_ALIGN double u_[kAtOnce], v_[kAtOnce], x_[kAtOnce], y_[kAtOnce];
  HWY_ALIGN float limit_[std::tuple_size_v<decltype(Corner::limit)>][kAtOnce];
};

struct StopPosition {
  Points x, y, x_by_u, y_by_u, x_by_v, y_by_v;
};

HWY_INLINE StopPosition stop_point(const IsoparametricCell::StopSeries& term, Points u, Points v) {
  const Tag d;
  const auto two_u = hn::Add(u, u), two_v = hn::Add(v, v);
  const auto along = [&](auto axis) HWY_ATTR {
    const auto t = [&](std::size_t k) HWY_ATTR { return hn::Set(d, axis(term[k])); };
    const auto sag_u = hn::MulAdd(t(6), v, t(4)), sag_v = hn::MulAdd(t(7), u, t(5));
    const auto by_u = hn::MulAdd(sag_u, u, t(1)), by_v = hn::MulAdd(sag_v, v, hn::MulAdd(t(3), u, t(2)));
    return std::array<Points, 3>{hn::MulAdd(by_v, v, hn::MulAdd(by_u, u, t(0))),
                                 hn::MulAdd(hn::MulAdd(t(7), v, t(3)), v, hn::MulAdd(sag_u, two_u, t(1))),
                                 hn::MulAdd(hn::MulAdd(t(6), u, t(3)), u, hn::MulAdd(sag_v, two_v, t(2)))};
  };
  const auto x = along([](Vec2 p) { return p.x; }), y = along([](Vec2 p) { return p.y; });
  return {x[0], y[0], x[1], y[1], x[2], y[2]};
}

// Finds the points whose rays cross the stop at x, y by Newton's method, starting from u, v; NaN where it fails.
HWY_INLINE void aim(const IsoparametricCell::StopSeries& stop, bool triangle, Points x, Points y, Points& u,
                    Points& v) {
  constexpr double kMiss = 0.1;  // stop radii
  constexpr double kNear = 1e-3;  // of the cell: below this step one more is as good as exact
  constexpr int kMaxSteps = 6;
  const Tag d;
  const auto none = hn::Zero(d), one = hn::Set(d, 1.0);
  for (int step = 0; step < kMaxSteps; ++step) {
    const StopPosition at = stop_point(stop, u, v);
    const auto off_x = hn::Sub(x, at.x), off_y = hn::Sub(y, at.y);
    const auto determinant = hn::MulSub(at.x_by_u, at.y_by_v, hn::Mul(at.y_by_u, at.x_by_v));
    const auto along_u = hn::Div(hn::MulSub(off_x, at.y_by_v, hn::Mul(off_y, at.x_by_v)), determinant);
    const auto along_v = hn::Div(hn::MulSub(at.x_by_u, off_y, hn::Mul(at.y_by_u, off_x)), determinant);
    // An arc does not leave the cell in which it was found.
    const auto next_u = hn::Min(hn::Max(hn::Add(u, along_u), none), one);
    const auto next_v = hn::Min(hn::Max(hn::Add(v, along_v), none), triangle ? next_u : one);
    const auto moved_u = hn::Sub(next_u, u), moved_v = hn::Sub(next_v, v);
    u = next_u;
    v = next_v;
    const auto moved = hn::MulAdd(moved_u, moved_u, hn::Mul(moved_v, moved_v));
    if (hn::AllTrue(d, hn::Lt(moved, hn::Set(d, kNear * kNear)))) break;
  }
  const StopPosition at = stop_point(stop, u, v);
  const auto off_x = hn::Sub(x, at.x), off_y = hn::Sub(y, at.y);
  const auto met = hn::Le(hn::MulAdd(off_x, off_x, hn::Mul(off_y, off_y)), hn::Set(d, kMiss * kMiss));
  u = hn::IfThenElse(met, u, hn::NaN(d));
}

void add_crossing(std::span<const Corner> cell, std::size_t limits, const IsoparametricCell::StopSeries& series,
                  std::span<const Vec2> stop, Vec2 near_uv, std::vector<Corner>& to) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN double x[kAtOnce], y[kAtOnce];
  for (std::size_t first = 0; first < stop.size(); first += lanes) {
    const std::size_t count = std::min(lanes, stop.size() - first);
    for (std::size_t k = 0; k < lanes; ++k) {
      const Vec2 stop_point = stop[first + std::min(k, count - 1)];
      x[k] = stop_point.x;
      y[k] = stop_point.y;
    }
    auto u = hn::Set(d, near_uv.x), v = hn::Set(d, near_uv.y);
    aim(series, cell.size() == 3, hn::Load(d, x), hn::Load(d, y), u, v);
    const CornersAt corners(cell, limits, u, v);
    for (std::size_t k = 0; k < count; ++k) {
      if (corners.is_none(k)) continue;
      to.push_back(corners[k]);
      near_uv = to.back().uv;
    }
  }
}

Corner corner_at(std::span<const Corner> cell, std::size_t limits, Vec2 uv) {
  const Tag d;
  return CornersAt(cell, limits, hn::Set(d, uv.x), hn::Set(d, uv.y))[0];
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::adaptive {
namespace {

HWY_EXPORT(add_crossing);
HWY_EXPORT(corner_at);

// The coefficients of a cell's interpolation between its corners, by powers of u and v.
IsoparametricCell::StopSeries stop_series(std::span<const Corner> cell, std::size_t limit) {
  const auto stop = [&](std::size_t k) { return Vec2{cell[k].limit[limit], cell[k].limit[limit + 1]}; };
  IsoparametricCell::StopSeries term{};
  term[0] = stop(0);
  if (cell.size() == 3) {
    term[1] = stop(1) - stop(0);
    term[2] = stop(2) - stop(1);
    return term;
  }
  const std::size_t by = cell.size() == IsoparametricCell::kCurvedCorners ? 2 : 1;
  const std::array<Vec2, 4> corner{stop(0), stop(by), stop(2 * by), stop(3 * by)};
  if (by == 2) {  // along each side c + u (d - c) + u (u - 1) sag
    const auto sag = [&](std::size_t a, std::size_t side, std::size_t b) {
      return (corner[a] + corner[b] - stop(side) * 2.0) * 2.0;
    };
    const Vec2 at_v0 = sag(0, 1, 1), at_u1 = sag(1, 3, 2), at_v1 = sag(3, 5, 2), at_u0 = sag(0, 7, 3);
    term[4] = at_v0;
    term[5] = at_u0;
    term[6] = at_v1 - at_v0;
    term[7] = at_u1 - at_u0;
  }
  term[1] = corner[1] - corner[0] - term[4];
  term[2] = corner[3] - corner[0] - term[5];
  term[3] = corner[2] - corner[1] - corner[3] + corner[0] - term[6] - term[7];
  return term;
}

}  // namespace

Corner IsoparametricCell::at(Vec2 uv) const { return HWY_DYNAMIC_DISPATCH(corner_at)(corners_, limits_, uv); }

void IsoparametricCell::add_crossing(std::span<const Vec2> stop, std::size_t limit, Vec2 near_uv,
                                     std::vector<Corner>& to) const {
  HWY_DYNAMIC_DISPATCH(add_crossing)(corners_, limits_, stop_series(corners_, limit), stop, near_uv, to);
}

}  // namespace contrejour::inline internal::adaptive
#endif  // HWY_ONCE
