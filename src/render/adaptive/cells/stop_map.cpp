// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/stop_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kThick_px = 2.0;  // cells thicker than this also get second-order terms

}  // namespace

CellSeries CellSeries::of(const std::array<Vec2, 4>& corner, const std::array<Vec2, 4>& side, Vec2 middle) {
  CellSeries out = of_corners(corner);
  out.middle = middle;
  // Means over three rows: the two sides and the line through the middle.
  out.u = (out.u * 4.0 + (side[1] - side[3])) * (1.0 / 6.0);
  out.v = (out.v * 4.0 + (side[2] - side[0])) * (1.0 / 6.0);
  out.uu = side[1] + side[3] - middle * 2.0;
  out.vv = side[0] + side[2] - middle * 2.0;
  return out;
}

// Takes half a cell, with corners 0, 1 and 2.
CellSeries CellSeries::of_triangle(const std::array<Vec2, 3>& c) {
  return {(c[0] + c[2]) * 0.5, (c[1] - c[0]) * 0.5, (c[2] - c[1]) * 0.5, {}, {}, {}};
}

// With J = [p_u p_v], the series of the pixels is inverted to second order, w = J^-1 q, and inserted into that of the
// stop: s = s_0 + A q + (s_2(w) - A p_2(w)) / 2, A = [s_u s_v] J^-1.
StopMap::StopMap(const CellSeries& pixel, std::span<const CellSeries> stop, double min_thickness_px)
    : origin_px_(pixel.middle), crossings_(stop.size()) {
  assert(!stop.empty() && stop.size() <= crossing_.size());
  const double uu = dot(pixel.u, pixel.u) + min_thickness_px * min_thickness_px;
  const double vv = dot(pixel.v, pixel.v) + min_thickness_px * min_thickness_px;
  const double uv = dot(pixel.u, pixel.v);
  const double det = uu * vv - uv * uv;
  const double scale = det > 0.0 ? 1.0 / det : 0.0;
  const Vec2 to_u = (pixel.u * vv - pixel.v * uv) * scale,
             to_v = (pixel.v * uu - pixel.u * uv) * scale;  // rows of J^-1
  const double determinant = std::abs(cross(pixel.u, pixel.v));
  const bool thick = 2.0 * determinant > kThick_px * std::sqrt(std::max(uu, vv));
  for (std::size_t c = 0; c < crossings_; ++c) {
    const CellSeries& s = stop[c];
    Crossing& out = crossing_[c];
    out.level = s.middle;
    out.x = s.u * to_u.x + s.v * to_v.x;
    out.y = s.u * to_u.y + s.v * to_v.y;
    out.width = std::sqrt(4.0 * std::abs(cross(s.u, s.v)) / std::max(4.0 * determinant, 1.0));
    if (!thick) continue;
    const auto second_order = [&](Vec2 of_stop, Vec2 of_pixel) {
      return (of_stop - out.x * of_pixel.x - out.y * of_pixel.y) * 0.5;
    };
    const Vec2 ruu = second_order(s.uu, pixel.uu), ruv = second_order(s.uv, pixel.uv),
               rvv = second_order(s.vv, pixel.vv);
    const auto form = [&](double u2, double uv2, double v2) { return ruu * u2 + ruv * uv2 + rvv * v2; };
    out.xx = form(to_u.x * to_u.x, 2.0 * to_u.x * to_v.x, to_v.x * to_v.x);
    out.yy = form(to_u.y * to_u.y, 2.0 * to_u.y * to_v.y, to_v.y * to_v.y);
    out.xy = form(2.0 * to_u.x * to_u.y, 2.0 * (to_u.x * to_v.y + to_u.y * to_v.x), 2.0 * to_v.x * to_v.y);
    nonlinearity_ = std::max({nonlinearity_, length(ruu + rvv + ruv * 2.0), length(ruu + rvv - ruv * 2.0)});
  }
}

std::span<const StopPoint> StopMap::stop_points(Vec2 pixel, std::array<StopPoint, kMaxStopCrossings>& buffer) const {
  for (std::size_t c = 0; c < crossings_; ++c) buffer[c] = {stop_point(pixel, c), crossing_[c].width};
  return {buffer.data(), crossings_};
}

}  // namespace contrejour::inline internal::adaptive
