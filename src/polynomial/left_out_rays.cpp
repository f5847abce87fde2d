// SPDX-License-Identifier: Apache-2.0
#include "polynomial/left_out_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "polynomial/chebyshev_basis.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr std::size_t kFewRays = 16;
// A ray that passes an edge outside by this fraction of its radius must not be let through.
constexpr double kBlockedBy = 0.01;

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

}  // namespace

double quantile(const std::vector<double>& rising, double fraction) {
  if (rising.empty()) return std::numeric_limits<double>::infinity();
  const auto last = static_cast<double>(rising.size() - 1);
  return rising[static_cast<std::size_t>(std::ceil(fraction * last))];
}

LeftOutRays::LeftOutRays(const LensPolynomials& lens, const GhostRays& rays, std::vector<RayStart> starts,
                         std::vector<RayStart> blocked_starts, Vec2 sensor_half_mm)
    : starts_(std::move(starts)), blocked_starts_(std::move(blocked_starts)),
      half_diagonal_mm_(length(sensor_half_mm)) {
  for (const double coordinate : kTestedWavelengths) {
    tables_.push_back(rays.trace(starts_, wavelength_at(lens, coordinate)));
    const RayTable& table = tables_.back();
    double largest = 0.0;
    for (std::size_t k = 0; k < table.size(); ++k) {
      if (table.clearance(k) > 1.0) continue;
      largest = std::max(largest, static_cast<double>(table.transmission[k]));
      const LeftOutRay sample{tables_.size() - 1, k};
      open_.push_back(sample);
      if (std::abs(table.sensor_x_mm[k]) < kLandingNear * half_diagonal_mm_ &&
          std::abs(table.sensor_y_mm[k]) < kLandingNear * half_diagonal_mm_)
        landing_.push_back(sample);
    }
    largest_transmittance_.push_back(largest);
  }
  if (landing_.size() < kFewRays) landing_ = open_;
  blocked_table_ = rays.trace(blocked_starts_, wavelength_at(lens, kTestedWavelengths[kBlockedWavelength]));
}

std::vector<double> LeftOutRays::position_errors_mm(const VectorAt& sensor) const {
  std::vector<double> errors;
  for (const LeftOutRay& sample : landing_) {
    const RayTable& table = tables_[sample.wavelength];
    errors.push_back(length(sensor(sample) - Vec2{table.sensor_x_mm[sample.ray], table.sensor_y_mm[sample.ray]}));
  }
  return sorted(std::move(errors));
}

std::vector<double> LeftOutRays::stop_errors(const VectorAt& stop, std::size_t crossing) const {
  std::vector<double> errors;
  for (const LeftOutRay& sample : open_) {
    const auto& traced = tables_[sample.wavelength].stop[crossing];
    errors.push_back(length(stop(sample) - Vec2{traced[0][sample.ray], traced[1][sample.ray]}));
  }
  return sorted(std::move(errors));
}

std::vector<double> LeftOutRays::rim_errors(const ScalarAt& squared, int step) const {
  std::vector<double> errors;
  for (const LeftOutRay& sample : open_) {
    const double traced = tables_[sample.wavelength].rim_squared[static_cast<std::size_t>(step)][sample.ray];
    // A radius, whose square has twice the relative error.
    errors.push_back(0.5 * std::abs(squared(sample) - traced) / std::max(traced, 0.5));
  }
  return sorted(std::move(errors));
}

std::vector<double> LeftOutRays::transmittance_errors(const ScalarAt& transmittance) const {
  std::vector<double> errors;
  for (const LeftOutRay& sample : landing_)
    errors.push_back(std::abs(transmittance(sample) - tables_[sample.wavelength].transmission[sample.ray]) /
                     std::max(largest_transmittance_[sample.wavelength], 1e-30));
  return sorted(std::move(errors));
}

bool LeftOutRays::brings_light_in(const VectorAt& sensor) const {
  return std::ranges::any_of(open_, [&](const LeftOutRay& sample) {
    const RayTable& table = tables_[sample.wavelength];
    const double landing_mm = std::hypot(table.sensor_x_mm[sample.ray], table.sensor_y_mm[sample.ray]);
    return landing_mm > kNearSensor * half_diagonal_mm_ && !(length(sensor(sample)) > kOnSensor * half_diagonal_mm_);
  });
}

bool LeftOutRays::admits_blocked_light(const ClearanceAt& of_rays, const ClearanceAt& of_blocked) const {
  const auto admits_any = [](const RayTable& table, std::size_t wavelength, const ClearanceAt& clearance) {
    for (std::size_t k = 0; k < table.size(); ++k)
      if (table.clearance(k) > 1.0 + kBlockedBy && !(clearance({wavelength, k}) > 1.0)) return true;
    return false;
  };
  for (std::size_t t = 0; t < tables_.size(); ++t)
    if (admits_any(tables_[t], t, of_rays)) return true;
  return admits_any(blocked_table_, kBlockedWavelength, of_blocked);
}

}  // namespace contrejour::inline internal::polynomial
