// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/pupil_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/starburst/smooth_fit.h"

namespace contrejour::inline internal {
namespace {

constexpr double kRimMargin = 0.1;     // about a rim, in which rays are used to find its circle in the stop
constexpr double kOutlineAgrees = 0.15;  // of the area

// The images in cosines of a plane's unit vectors, from the points at which these rays cross the plane.
std::array<Vec2, 2> axes_in_cosines(const PupilRays& pupil, const std::vector<std::size_t>& rays,
                                    const std::vector<Vec2>& points) {
  std::vector<double> values;
  for (const std::size_t k : rays) values.push_back(pupil.rays[k].cosines.x);
  for (const std::size_t k : rays) values.push_back(pupil.rays[k].cosines.y);
  const SmoothFit fit(points, values, 1);
  const auto step = [&](Vec2 to) { return Vec2{fit(to, 0) - fit({}, 0), fit(to, 1) - fit({}, 1)}; };
  return {step({1.0, 0.0}), step({0.0, 1.0})};
}

// A rim as it is projected onto the stop: rays near the rim are moved onto it along the gradient of their distance, and
// a circle is fitted to these points (Kasa 1976: linear in centre and radius squared).
std::optional<IrisBound> rim_as_seen_from_stop(const PupilRays& pupil, std::size_t rim) {
  std::vector<Vec2> stops;
  std::vector<double> outside;
  for (std::size_t k = 0; k < pupil.rays.size(); ++k) {
    const PupilRay& ray = pupil.rays[k];
    const double beyond = length(pupil.at_rim(rim, k)) - 1.0;
    if (!ray.arrived || ray.blocked > kRimMargin || std::abs(beyond) > kRimMargin) continue;
    stops.push_back(ray.stop);
    outside.push_back(beyond);
  }
  if (stops.size() < SmoothFit::kPointsPerTerm * SmoothFit::terms(2)) return std::nullopt;
  const SmoothFit level(stops, outside, 2);
  std::vector<double> minus_squares;
  constexpr double h = 1e-5;
  for (Vec2& at : stops) {
    for (int step = 0; step < 2; ++step) {
      const double here = level(at);
      const Vec2 slope = Vec2{level(at + Vec2{h, 0.0}) - here, level(at + Vec2{0.0, h}) - here} * (1.0 / h);
      at = at - slope * (here / std::max(dot(slope, slope), 1e-12));
    }
    minus_squares.push_back(-dot(at, at));
  }
  const SmoothFit circle(stops, minus_squares, 1);
  const double at_zero = circle({});
  IrisBound bound;
  bound.centre = Vec2{circle({1.0, 0.0}) - at_zero, circle({0.0, 1.0}) - at_zero} * -0.5;
  bound.radius = std::sqrt(dot(bound.centre, bound.centre) - at_zero);
  if (!(bound.radius > 0.0) || !std::isfinite(bound.radius)) return std::nullopt;
  return bound;
}

// The areas of the pupil that obscurations cover, each as the part of its disc that would be open without it.
std::vector<double> obscured_areas(const PupilRays& pupil, const std::vector<std::size_t>& rims,
                                   const std::vector<std::size_t>& used) {
  std::vector<double> areas;
  std::vector<std::size_t> before;
  for (const std::size_t rim : rims) {
    if (!pupil.blocks_within[rim]) continue;
    std::vector<Vec2> points;
    for (const std::size_t k : used) points.push_back(pupil.at_rim(rim, k));
    const auto axes = axes_in_cosines(pupil, used, points);
    const auto is_within = [&](std::size_t of, std::size_t ray) { return length(pupil.at_rim(of, ray)) < 1.0; };
    int within = 0, dark = 0;
    for (std::size_t k = 0; k < pupil.rays.size(); ++k) {
      if (!pupil.rays[k].arrived || !is_within(rim, k)) continue;
      const bool is_dark = std::any_of(before.begin(), before.end(), [&](std::size_t r) { return is_within(r, k); });
      ++within;
      dark += is_dark || pupil.rays[k].blocked > 0.0 ? 1 : 0;
    }
    const double open = within == 0 ? 1.0 : 1.0 - static_cast<double>(dark) / within;  // 0 rays: it is small
    if (open > 0.0) areas.push_back(open * std::numbers::pi * std::abs(cross(axes[0], axes[1])));
    before.push_back(rim);
  }
  return areas;
}

}  // namespace

std::optional<PupilOutline> outline_of(const PupilRays& pupil, const OutlineRays& of, const Iris& iris,
                                       double open_area) {
  if (iris.field) return std::nullopt;
  std::vector<IrisBound> cuts;
  for (const std::size_t rim : of.rims) {
    if (pupil.blocks_within[rim]) continue;
    if (const auto cut = rim_as_seen_from_stop(pupil, rim)) cuts.push_back(*cut);
  }
  std::vector<Vec2> stops;
  for (const std::size_t k : of.open) stops.push_back(pupil.rays[k].stop);
  const auto axes = axes_in_cosines(pupil, of.open, stops);
  PupilOutline outline{IrisOpening(iris, cuts), axes[0], axes[1]};
  outline.obscured_mm2 = obscured_areas(pupil, of.rims, of.used);
  outline.slope_spread_rad = iris_slope_spread_rad(iris);
  if (!(std::abs(outline.area_mm2() / open_area - 1.0) < kOutlineAgrees)) return std::nullopt;
  return outline;
}

}  // namespace contrejour::inline internal
