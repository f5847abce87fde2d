// SPDX-License-Identifier: Apache-2.0
#include "polynomial/direct_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/tasks.h"
#include "polynomial/direct_evaluate.h"
#include "polynomial/node_polynomials.h"
#include "polynomial/zone_nodes.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kHeights = 19, kPointsAtHeight = 128;
constexpr double kRowsPerUnknown = 2.0, kSystemRidge = 1e-7;  // as for ghosts
constexpr double kFall = 48.0;  // how steeply rays that are blocked count less

// Points of the upper half of the disc of stop points, denser towards its edge as Chebyshev points are in the square of
// the distance from its middle; the k-th ones of a sequence that fills it evenly (Roberts' R2 sequence).
Vec2 stop_sample(std::size_t k) {
  constexpr double kStepRadius = 0.7548776662466927, kStepAngle = 0.5698402909980532;
  const double radius = std::sin(0.5 * std::numbers::pi * std::fmod(0.5 + kStepRadius * static_cast<double>(k), 1.0));
  const double angle = std::numbers::pi * std::fmod(0.5 + kStepAngle * static_cast<double>(k), 1.0);
  return Vec2{std::cos(angle), std::sin(angle)} * (DirectPolynomials::kMargin * radius);
}

std::vector<SensorAndStop> all_points(const DirectPolynomials& frame) {
  std::vector<SensorAndStop> points;
  for (int k = 0; k < kHeights; ++k) {
    // Chebyshev points in the square of the height.
    const double height = frame.max_height_mm * std::sqrt(0.5 * (1.0 - node_coordinate(k, kHeights)));
    for (int j = 0; j < kPointsAtHeight; ++j) points.push_back({{height, 0.0}, stop_sample(points.size() + 1)});
  }
  return points;
}

// The rays through all points at one wavelength. Each starts from the one to the middle of the stop.
std::vector<std::optional<CameraRay>> rays_through(const CameraRays& rays, std::span<const SensorAndStop> points) {
  std::vector<std::optional<CameraRay>> traced(points.size());
  std::optional<Vec2> chief, before;
  double height_mm = -1.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [sensor_mm, stop] = points[k];
    if (sensor_mm.x != height_mm) {
      height_mm = sensor_mm.x;
      before = chief;
      chief = rays.aimed(sensor_mm, {}, before ? *before : rays.straight(sensor_mm, {}));
    }
    if (!chief) continue;
    const auto inner = rays.aimed(sensor_mm, stop, *chief);
    if (inner) traced[k] = rays.trace_from(sensor_mm, *inner);
  }
  return traced;
}

}  // namespace

DirectSamples direct_samples(const LensState& lens, const DirectPolynomials& frame, const Context& context) {
  const std::vector<SensorAndStop> points = all_points(frame);
  std::array<std::vector<std::optional<CameraRay>>, kDirectWavelengths> traced;
  const bool done = parallel_for(kDirectWavelengths, context, [&](std::size_t l) {
    const double lambda_nm = direct_wavelength_nm(frame, node_coordinate(static_cast<int>(l), kDirectWavelengths));
    traced[l] = rays_through(CameraRays(lens, lambda_nm, frame.front_z_mm), points);
  });
  DirectSamples samples;
  if (!done) return samples;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::ranges::any_of(traced, [k](const auto& rays) { return !rays[k].has_value(); })) continue;
    double clearance = length(points[k].stop);
    for (const auto& rays : traced) clearance = std::max(clearance, rays[k]->largest_height);
    samples.points.push_back(points[k]);
    samples.clearance.push_back(clearance);
    for (std::size_t l = 0; l < traced.size(); ++l) samples.rays[l].push_back(*traced[l][k]);
  }
  return samples;
}

DirectSystem::DirectSystem(const DirectSamples& samples, const DirectPolynomials& frame, double farthest)
    : samples_(samples), frame_(frame) {
  for (std::size_t k = 0; k < samples.points.size(); ++k) {
    if (!(samples.clearance[k] < farthest)) continue;
    used_.push_back(k);
    // Points of the stop's margin count fully.
    weight_.push_back(std::pow(std::max(samples.clearance[k] / DirectPolynomials::kMargin, 1.0), -kFall));
  }
}

bool DirectSystem::has_enough_rays(int degree) const {
  return static_cast<double>(used_.size()) >= kRowsPerUnknown * term_count(degree);
}

Rows DirectSystem::matrix(int degree, bool of_vectors) const {
  std::vector<ZonePoint> points;
  for (const std::size_t sample : used_) {
    const auto& [sensor_mm, stop] = samples_.points[sample];
    ZonePoint& point = points.emplace_back();
    point.h = sensor_mm.x / frame_.max_height_mm;
    point.p = stop * (1.0 / DirectPolynomials::kMargin);
    point.u = 2.0 * point.h * point.h - 1.0;
    point.v = point.h * point.p.x;
    point.w = 2.0 * dot(point.p, point.p) - 1.0;
  }
  return weighted_rows(degree, of_vectors, points, weight_);
}

std::vector<ChebyshevVector> DirectSystem::vectors(int degree, std::span<const Member> members) const {
  const LeastSquares system(matrix(degree, true), kSystemRidge);
  std::vector<ChebyshevVector> vectors;
  std::vector<double> right(2 * used_.size());
  for (const auto& [member, negligible] : members) {
    std::vector<std::vector<double>> solutions;
    for (std::size_t l = 0; l < kDirectWavelengths; l += kWavelengthStep) {
      for (std::size_t k = 0; k < used_.size(); ++k) {
        const Vec2 value = samples_.rays[l][used_[k]].*member;
        right[2 * k] = weight_[k] * value.x;
        right[2 * k + 1] = weight_[k] * value.y;
      }
      solutions.push_back(system.solve(right));
    }
    const auto count = static_cast<std::size_t>(term_count(degree));
    vectors.push_back(
        {assembled(degree, count, solutions, 0, negligible), assembled(degree, count, solutions, count, negligible)});
  }
  return vectors;
}

ChebyshevSum DirectSystem::solved(int degree, const std::vector<std::vector<double>>& rights, double negligible) const {
  const LeastSquares system(matrix(degree, false), kSystemRidge);
  std::vector<std::vector<double>> solutions;
  for (const std::vector<double>& right : rights) solutions.push_back(system.solve(right));
  return assembled(degree, static_cast<std::size_t>(term_count(degree)), solutions, 0, negligible);
}

}  // namespace contrejour::inline internal::polynomial
