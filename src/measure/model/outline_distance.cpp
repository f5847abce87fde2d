// SPDX-License-Identifier: Apache-2.0
#include "measure/model/outline_distance.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

constexpr int kMaxSteps = 40;
constexpr double kSameParameter = 1e-14;
constexpr double kNoTangent = 1e-12;  // of the chord: a shorter tangent has no direction
constexpr double kLastStep = 1e-8;  // of Newton's method, whose error is about the square of its last step

GhostOutline about_its_centre(GhostOutline outline) {
  outline.centre = 0.0;
  return outline;
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

OutlineDistance::Arc::Arc(const OutlineCubic& relative)
    : chord(relative.control[3] - relative.control[0]), power(relative.power_basis()) {
  for (std::size_t k = 0; k <= kSamples; ++k) {
    const double t = static_cast<double>(k) / kSamples;
    const Vec2 tangent = relative.derivative(t);
    tangent_x[k] = tangent.x;
    tangent_y[k] = tangent.y;
    along[k] = dot(relative.at(t), tangent);
  }
}

Vec2 OutlineDistance::Arc::at(double t) const { return ((power[3] * t + power[2]) * t + power[1]) * t + power[0]; }

Vec2 OutlineDistance::Arc::derivative(double t) const { return (power[3] * (3.0 * t) + power[2] * 2.0) * t + power[1]; }

Vec2 OutlineDistance::Arc::outward_normal(double t) const {
  Vec2 tangent = derivative(t);
  if (dot(tangent, tangent) <= kNoTangent * kNoTangent * dot(chord, chord)) tangent = chord;
  const double size = length(tangent);
  return size > 0.0 ? Vec2{-tangent.y / size, tangent.x / size} : Vec2{0.0, 1.0};
}

double OutlineDistance::Arc::squared_distance(double t, Vec2 point) const {
  const Vec2 offset = at(t) - point;
  return dot(offset, offset);
}

// The minimum between two parameters where the slope changes from negative to positive: Newton's steps from where a
// line would cross 0, replaced by halves of the interval wherever they leave it (walch2018: twelve bisections).
double OutlineDistance::Arc::minimum(Vec2 point, Slope from, Slope to) const {
  double low = from.t, high = to.t;
  double t = low + (high - low) * from.value / (from.value - to.value);
  for (int step = 0; step < kMaxSteps && high - low > kSameParameter; ++step) {
    const Vec2 offset = at(t) - point, first = derivative(t);
    const Vec2 second = power[3] * (6.0 * t) + power[2] * 2.0;
    const double slope = dot(offset, first);
    (slope < 0.0 ? low : high) = t;
    const double next = t - slope / (dot(first, first) + dot(offset, second));
    if (std::abs(next - t) < kLastStep) return std::clamp(next, 0.0, 1.0);
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

OutlineDistance::Nearest OutlineDistance::Arc::nearest(Vec2 point) const {
  std::array<double, kSamples + 1> slope{};
  for (std::size_t k = 0; k <= kSamples; ++k) slope[k] = along[k] - point.x * tangent_x[k] - point.y * tangent_y[k];
  Nearest best{squared_distance(0.0, point), 0.0};
  const auto consider = [&](double t) {
    const double squared = squared_distance(t, point);
    if (squared < best.squared) best = {squared, t};
  };
  consider(1.0);
  for (std::size_t k = 1; k <= kSamples; ++k) {
    const double t = static_cast<double>(k) / kSamples;
    if (slope[k - 1] < 0.0 && slope[k] >= 0.0)
      consider(minimum(point, {t - 1.0 / kSamples, slope[k - 1]}, {t, slope[k]}));
  }
  return best;
}

OutlineDistance::OutlineDistance(const GhostOutline& outline)
    : outline_(outline), left_(left_cubic(about_its_centre(outline))), right_(right_cubic(about_its_centre(outline))) {}

OutlinePoint OutlineDistance::nearest(Vec2 point) const {
  const Vec2 above{point.x, std::abs(point.y)}, relative{point.x - outline_.centre, above.y};
  const Nearest on_left = left_.nearest(relative), on_right = right_.nearest(relative);
  OutlinePoint nearest;
  nearest.is_below = point.y < 0.0;
  nearest.is_right = on_right.squared < on_left.squared;
  nearest.t = nearest.is_right ? on_right.t : on_left.t;
  const Arc& arc = nearest.is_right ? right_ : left_;
  const Vec2 offset = relative - arc.at(nearest.t);
  nearest.normal = arc.outward_normal(nearest.t);
  nearest.distance = std::copysign(length(offset), dot(offset, nearest.normal));
  if (outline_.clip_radius > 0.0) cut(outline_, above, nearest);
  if (nearest.is_below) nearest.normal.y = -nearest.normal.y;
  return nearest;
}

}  // namespace contrejour::inline internal
