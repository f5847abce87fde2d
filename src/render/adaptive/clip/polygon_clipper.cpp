// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/clip/polygon_clipper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kSmallAngle = 1e-3;  // radians: smaller ones may be rounding
constexpr double kLongestStep = 0.8;  // radians
constexpr double kChord = 0.15;  // radians: a longer arc's only chord would lose 0.4 per cent of the circle's area
// If several bounds leave a part of a cell, chords miss their arcs by at most this fraction of that part's width:
// its corners are where bounds meet, and lie on chords of the bounds that clipped it before.
constexpr double kOffWidth = 0.003;
constexpr double kShortestStep = 0.01;  // radians

}  // namespace

// Keeps the part where value(corner), linear along the sides, is <= 0 (Sutherland & Hodgman 1974). In a cell with
// curved sides the cut is curved like them.
template <class Value>
void PolygonClipper::clip_where_positive(Value value) {
  next_.clear();
  exits_.clear();
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& a = polygon_[k];
    const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const double fa = value(a);
    const double fb = value(b);
    if (fa <= 0.0) next_.push_back(a);
    if ((fa <= 0.0) == (fb <= 0.0)) continue;
    if (fa <= 0.0) exits_.push_back(next_.size());
    next_.push_back(between(a, b, fa / (fa - fb)));
  }
  if (!exits_.empty() || next_.empty()) ++cuts_;
  if (cell_.is_curved()) curve_cuts(value);
  polygon_.swap(next_);
}

// Inserts one corner between the point where the outline leaves the kept part and the point where it returns. The cut
// is a parabola over the chord of these two points; the triangle with the parabola's area is 4/3 as high.
template <class Value>
void PolygonClipper::curve_cuts(Value value) {
  constexpr double kTrial = 0.125;  // of the chord: how far to either side of its middle `value` is sampled
  constexpr double kMaxHeight = 0.5;
  for (std::size_t k = exits_.size(); k-- > 0;) {
    const Vec2 from = next_[exits_[k]].uv;
    const Vec2 chord = next_[exits_[k] + 1 == next_.size() ? 0 : exits_[k] + 1].uv - from;
    const Vec2 middle = from + chord * 0.5;
    const Vec2 normal{-chord.y, chord.x};
    const double here = value(cell_.at(middle));
    const double there = value(cell_.at(middle + normal * kTrial)) - here;
    const double back = value(cell_.at(middle - normal * kTrial)) - here;
    const double slope = 0.5 * (there - back);
    const double curvature = 0.5 * (there + back);
    const double root = std::sqrt(slope * slope - 4.0 * curvature * here);
    const double height = -2.0 * here / (slope + std::copysign(root, slope)) * kTrial;
    if (!(std::abs(height) < kMaxHeight)) continue;  // NaN where it has no zero
    const Vec2 uv = middle + normal * (4.0 / 3.0 * height);
    next_.insert(next_.begin() + static_cast<std::ptrdiff_t>(exits_[k]) + 1,
                 cell_.at({std::clamp(uv.x, 0.0, 1.0), std::clamp(uv.y, 0.0, 1.0)}));
  }
}

// The stop coordinates are linear along each side, so that sides are intersected with the circle exactly. Where the
// outline leaves the circle, an arc connects it to where it returns.
void PolygonClipper::clip_by_circle(const Circle& circle) {
  const auto stop = [&circle](const Corner& c) { return circle.unit_from_stop(c); };
  next_.clear();
  exits_.clear();
  double twice_area = 0.0;
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& a = polygon_[k];
    const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const Vec2 s = stop(a);
    const Vec2 along = stop(b) - s;
    twice_area += cross(s, stop(b));
    const bool starts_inside = dot(s, s) <= 1.0;
    const bool ends_inside = dot(stop(b), stop(b)) <= 1.0;
    if (starts_inside) next_.push_back(a);
    if (starts_inside && ends_inside) continue;
    // This is the point at which the side meets the circle. The corners were classified above, which rounding here must
    // not contradict.
    const double aa = dot(along, along);
    const double half_b = dot(s, along);
    const double under = half_b * half_b - aa * (dot(s, s) - 1.0);
    const bool meets = under > 0.0 && aa > 0.0;
    const double enters = meets ? (-half_b - std::sqrt(under)) / aa : 1.0;  // a tangent side is met at its end
    const double leaves = meets ? (-half_b + std::sqrt(under)) / aa : 0.0;
    const bool passes_through = !starts_inside && !ends_inside;
    if (passes_through && !(meets && enters > 0.0 && leaves < 1.0)) continue;
    if (!starts_inside) next_.push_back(between(a, b, std::clamp(enters, 0.0, 1.0)));
    if (!ends_inside) {
      exits_.push_back(next_.size());
      next_.push_back(between(a, b, std::clamp(leaves, 0.0, 1.0)));
    }
  }
  // The circle is cut by a single side, or by none.
  const bool nearly_whole = next_.size() <= 2 && surrounds_centre(circle);
  const double orientation = twice_area > 0.0 ? 1.0 : -1.0;
  polygon_.clear();
  if (!exits_.empty() || next_.empty()) ++cuts_, ++arcs_;
  if (next_.empty()) {
    if (nearly_whole) add_circle(circle, orientation);
    return;
  }
  std::size_t exit = 0;
  for (std::size_t k = 0; k < next_.size(); ++k) {
    polygon_.push_back(next_[k]);
    if (exit == exits_.size() || exits_[exit] != k) continue;
    ++exit;
    const Vec2 from = stop(next_[k]);
    const Vec2 to = stop(next_[k + 1 == next_.size() ? 0 : k + 1]);
    double angle = std::atan2(cross(from, to), dot(from, to));
    // A small angle backwards is rounding, except where a single side cuts the circle: there it is nearly a whole turn.
    if (angle * orientation < 0.0 && (std::abs(angle) > kSmallAngle || nearly_whole))
      angle += orientation * 2.0 * std::numbers::pi;
    if (angle * orientation > 0.0) add_arc(circle, from, angle, next_[k].uv);
  }
}

bool PolygonClipper::surrounds_centre(const Circle& circle) const {
  bool left = false;
  bool right = false;
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& a = polygon_[k];
    const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const double side = cross(circle.unit_from_stop(a), circle.unit_from_stop(b));
    (side > 0.0 ? left : right) = true;
  }
  return left != right;
}

// The step at which chords of this circle miss their arcs by as much as those of arc_step_ do on the unit circle.
double PolygonClipper::step_on(const Circle& circle) const {
  return std::min(arc_step_ / std::sqrt(circle.radius), kLongestStep);
}

// Adds the corners along an arc, without its ends, which lie on the circle; angles are about the circle's centre. The
// corners lie slightly outside, so that the chords enclose the arc's area: (n - 2) r^2 + 2 r = n step / sin(step).
// from: the beginning of the arc relative to the centre, at near_uv or close to it.
void PolygonClipper::add_arc(const Circle& circle, Vec2 from, double angle, Vec2 near_uv) {
  const int min_count = std::abs(angle) > kChord ? 2 : 1;
  const int steps = std::max(static_cast<int>(std::ceil(std::abs(angle) / step_on(circle))), min_count);
  if (steps < 2) return;
  const double step = angle / steps;
  const double excess = steps * step / std::sin(step);
  const double radius = steps == 2 ? 0.5 * excess : (std::sqrt(1.0 + (steps - 2) * excess) - 1.0) / (steps - 2);
  const double start = std::atan2(from.y, from.x) + step;
  add_corners(circle, Vec2{std::cos(start), std::sin(start)} * radius, step, steps - 1, near_uv);
}

// Adds the whole circle as a regular polygon of the same area.
void PolygonClipper::add_circle(const Circle& circle, double orientation) {
  const int steps = std::max(3, static_cast<int>(std::ceil(2.0 * std::numbers::pi / step_on(circle))));
  const double step = 2.0 * std::numbers::pi / steps;
  add_corners(circle, {std::sqrt(step / std::sin(step)), 0.0}, orientation * step, steps, {0.5, 0.5});
}

// Adds `count` corners, each rotated by one step about the circle's centre from the one before.
void PolygonClipper::add_corners(const Circle& circle, Vec2 first, double step, int count, Vec2 near_uv) {
  const Vec2 orientation{std::cos(step), std::sin(step)};
  arc_.clear();
  for (int k = 0; k < count; ++k) {
    arc_.push_back(circle.stop_from_unit(first));
    first = {first.x * orientation.x - first.y * orientation.y, first.x * orientation.y + first.y * orientation.x};
  }
  cell_.add_crossing(arc_, circle.limit, near_uv, polygon_);
}

Corner PolygonClipper::between(const Corner& a, const Corner& b, double t) const {
  Corner c;
  c.position = a.position + (b.position - a.position) * t;
  c.uv = a.uv + (b.uv - a.uv) * t;
  for (std::size_t l = 0; l < cell_.limits(); ++l)
    c.limit[l] = a.limit[l] + static_cast<float>(t) * (b.limit[l] - a.limit[l]);
  return c;
}

std::span<const Corner> PolygonClipper::open_part(std::span<const Corner> whole, std::span<const Corner> outline,
                                                  int crossings, int rims, double arc_step_rad) {
  const auto cut = [&](double step_rad) {
    start_with(whole, outline, crossings, rims);
    arc_step_ = step_rad;
    for (int c = 0; c < crossings && !polygon_.empty(); ++c) clip_by_iris(static_cast<std::size_t>(2 * c));
    clip_by_rims(crossings, rims);
  };
  cut(arc_step_rad);
  if (cuts_ < 2 || arcs_ == 0) return polygon_;
  const double finer = std::max(std::sqrt(8.0 * kOffWidth * width_in_stop()), kShortestStep);
  if (finer < arc_step_rad) cut(finer);
  return polygon_;
}

// The width of what is open, in stop radii: its area over half of its length. Where nothing is open, the width that
// coarse arcs may have lost.
double PolygonClipper::width_in_stop() const {
  constexpr double kLost = 0.1;
  if (polygon_.size() < 3) return kLost;
  const auto stop_point = [&](std::size_t k) { return Vec2{polygon_[k].limit[0], polygon_[k].limit[1]}; };
  double twice_area = 0.0, longest = 0.0;
  for (std::size_t k = 1; k < polygon_.size(); ++k) {
    longest = std::max(longest, length(stop_point(k) - stop_point(0)));
    if (k > 1) twice_area += cross(stop_point(k - 1) - stop_point(0), stop_point(k) - stop_point(0));
  }
  return longest > 0.0 ? std::abs(twice_area) / longest : 0.0;
}

std::span<const Corner> PolygonClipper::within_rims(std::span<const Corner> whole, std::span<const Corner> outline,
                                                    int crossings, int rims) {
  start_with(whole, outline, crossings, rims);
  clip_by_rims(crossings, rims);
  return polygon_;
}

void PolygonClipper::start_with(std::span<const Corner> whole, std::span<const Corner> outline, int crossings,
                                int rims) {
  cell_ = {whole, static_cast<std::size_t>(2 * crossings + rims)};
  polygon_.assign(outline.begin(), outline.end());
  cuts_ = arcs_ = 0;
}

void PolygonClipper::clip_by_rims(int crossings, int rims) {
  for (int r = 0; r < rims && !polygon_.empty(); ++r) {
    const auto limit = static_cast<std::size_t>(2 * crossings + r);
    clip_where_positive([&](const Corner& p) { return static_cast<double>(p.limit[limit]) - 1.0; });
  }
}

// Clips triangles, over which the stop coordinates are linear, so that cuts of neighbouring pieces meet.
void PolygonClipper::for_each_open_part(std::span<const Corner> whole, int crossings, int rims, double finest,
                                        const OpenPart& visit) {
  cell_ = {{}, static_cast<std::size_t>(2 * crossings + rims)};
  for (std::size_t k = 2; k < whole.size(); ++k) {
    polygon_.assign({whole[0], whole[k - 1], whole[k]});
    clip_by_rims(crossings, rims);
    clip_by_pieces(0, static_cast<std::size_t>(2 * crossings), finest, 1.0, visit);
  }
}

void PolygonClipper::clip_by_pieces(std::size_t limit, std::size_t first_rim, double finest, double open,
                                    const OpenPart& visit) {
  if (polygon_.size() < 3) return;
  if (limit == first_rim) return visit(polygon_, open);
  const std::vector<Corner> before = polygon_;
  Vec2 low{before[0].limit[limit], before[0].limit[limit + 1]};
  Vec2 high = low;
  for (const Corner& c : before) {
    low = {std::min<double>(low.x, c.limit[limit]), std::min<double>(low.y, c.limit[limit + 1])};
    high = {std::max<double>(high.x, c.limit[limit]), std::max<double>(high.y, c.limit[limit + 1])};
  }
  const double detail = finest * std::max(high.x - low.x, high.y - low.y);
  iris_.for_each_piece(low, high, detail, [&](std::span<const IrisBound> half_planes, double fraction) {
    polygon_ = before;
    for (const IrisBound& bound : half_planes)
      if (!is_inside(limit, bound)) clip_by_line(limit, bound);
    clip_by_pieces(limit + 2, first_rim, finest, open * fraction, visit);
  });
}

bool PolygonClipper::is_inside(std::size_t limit, const IrisBound& half_plane) const {
  return std::all_of(polygon_.begin(), polygon_.end(),
                     [&](const Corner& c) { return half_plane.distance({c.limit[limit], c.limit[limit + 1]}) <= 0.0; });
}

void PolygonClipper::clip_by_line(std::size_t limit, const IrisBound& bound) {
  clip_where_positive([&](const Corner& p) {
    return bound.normal.x * p.limit[limit] + bound.normal.y * p.limit[limit + 1] - bound.apothem;
  });
}

void PolygonClipper::clip_by_iris(std::size_t limit) {
  for (const IrisBound& bound : iris_.bounds()) {
    if (polygon_.empty()) return;
    if (bound.straight())
      clip_by_line(limit, bound);
    else
      clip_by_circle({limit, bound.centre, bound.radius});
  }
}

}  // namespace contrejour::inline internal::adaptive
