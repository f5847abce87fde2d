// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/ghost_outline.h"

#include <algorithm>
#include <cmath>

#include "measure/model/outline_cubic.h"

namespace contrejour {
namespace {

// The distance from a point inside an outline may have several minima along one cubic: it is sampled this finely before
// they are refined.
constexpr int kSamples = 12;
constexpr int kMaxSteps = 40;
constexpr double kSameParameter = 1e-14;

struct Candidate {
  double squared = 0;
  double t = 0;
};

// Half of the derivative of the squared distance with respect to t.
double slope_at(const OutlineCubic& cubic, double t, Vec2 point) {
  return dot(cubic.at(t) - point, cubic.derivative(t));
}

// The root of the slope between low and high, where it changes from negative to positive: Newton's steps, replaced by
// halves of the interval wherever they leave it (walch2018: twelve bisections).
double refined(const OutlineCubic& cubic, Vec2 point, double low, double high) {
  double t = 0.5 * (low + high);
  for (int step = 0; step < kMaxSteps && high - low > kSameParameter; ++step) {
    const double slope = slope_at(cubic, t, point);
    (slope < 0.0 ? low : high) = t;
    const Vec2 first = cubic.derivative(t);
    const double curvature = dot(first, first) + dot(cubic.at(t) - point, cubic.second_derivative(t));
    const double next = t - slope / curvature;
    if (std::abs(next - t) < kSameParameter) return std::clamp(next, 0.0, 1.0);
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

// The nearest point of a cubic.
Candidate nearest_on(const OutlineCubic& cubic, Vec2 point) {
  Candidate best{};
  const auto consider = [&](double t, bool first) {
    const Vec2 offset = cubic.at(t) - point;
    const double squared = dot(offset, offset);
    if (first || squared < best.squared) best = {squared, t};
  };
  consider(0.0, true);
  consider(1.0, false);
  double slope = slope_at(cubic, 0.0, point);
  for (int k = 1; k <= kSamples; ++k) {
    const double t = static_cast<double>(k) / kSamples;
    const double next = slope_at(cubic, t, point);
    if (slope < 0.0 && next >= 0.0) consider(refined(cubic, point, t - 1.0 / kSamples, t), false);
    slope = next;
  }
  return best;
}

// An intersection's distance is the larger of both, as far as it has no corners.
void cut(const GhostOutline& outline, Vec2 above, OutlinePoint& nearest) {
  const Vec2 offset = above - Vec2{outline.clip_centre, 0.0};
  const double from_centre = length(offset), distance = from_centre - outline.clip_radius;
  if (distance <= nearest.distance) return;
  nearest.distance = distance;
  nearest.normal = from_centre > 0.0 ? offset * (1.0 / from_centre) : Vec2{1.0, 0.0};
  nearest.is_on_clip = true;
}

}  // namespace

OutlinePoint nearest_point(const GhostOutline& outline, Vec2 point) {
  const Vec2 above{point.x, std::abs(point.y)};
  const OutlineCubic left = left_cubic(outline), right = right_cubic(outline);
  const Candidate on_left = nearest_on(left, above), on_right = nearest_on(right, above);
  OutlinePoint nearest;
  nearest.is_below = point.y < 0.0;
  nearest.is_right = on_right.squared < on_left.squared;
  nearest.t = nearest.is_right ? on_right.t : on_left.t;
  const OutlineCubic& cubic = nearest.is_right ? right : left;
  const Vec2 offset = above - cubic.at(nearest.t);
  nearest.normal = cubic.outward_normal(nearest.t);
  nearest.distance = std::copysign(length(offset), dot(offset, nearest.normal));
  if (outline.clip_radius > 0.0) cut(outline, above, nearest);
  if (nearest.is_below) nearest.normal.y = -nearest.normal.y;
  return nearest;
}

std::array<double, kOutlineParameters> distance_gradient(const GhostOutline& outline, const OutlinePoint& nearest) {
  if (nearest.is_on_clip) return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -nearest.normal.x, -1.0};
  const Vec2 normal{nearest.normal.x, nearest.is_below ? -nearest.normal.y : nearest.normal.y};
  const std::array<Vec2, kCubicParameters> moved =
      nearest.is_right ? right_derivatives(outline, nearest.t) : left_derivatives(outline, nearest.t);
  std::array<double, kOutlineParameters> gradient{};
  std::transform(moved.begin(), moved.end(), gradient.begin(), [&](Vec2 by) { return -dot(normal, by); });
  return gradient;
}

}  // namespace contrejour
