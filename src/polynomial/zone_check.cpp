// SPDX-License-Identifier: Apache-2.0
#include "polynomial/zone_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kTestedFields = 13, kTestedAtField = 24;
// More rays, at the middle of these wavelengths, that must not be let through if they are blocked: edges count little
// where a fit may turn back.
constexpr int kBlockedAtField = 96;
constexpr std::size_t kFirstIndex = 100'003;  // in the sequence of points, beyond those of fits
constexpr std::array kTestedWavelengths{-0.86, -0.11, 0.57};  // coordinates, none of which is a node of the fit
constexpr double kBlockedWavelength = kTestedWavelengths[1];
constexpr double kLandingNear = 1.1;  // of its size
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

ZoneCheck::ZoneCheck(const LensPolynomials& lens, const GhostRays& rays, const PolynomialZone& zone,
                     Vec2 sensor_half_mm) {
  const double low = zone.field_low * zone.field_low, high = zone.field_high * zone.field_high;
  std::vector<PolynomialBounds> bounds;
  for (int k = 0; k < kTestedFields; ++k)
    bounds.push_back(bounds_between(zone, std::sqrt(low + (high - low) * (k + 0.5) / kTestedFields)));
  starts_ = starts_within(bounds, kTestedAtField, kFirstIndex);
  blocked_starts_ = starts_within(bounds, kBlockedAtField, kFirstIndex + starts_.size());
  for (const RayStart& start : starts_) points_.push_back(zone_point(zone, start.field, start.entrance_mm));
  for (const double coordinate : kTestedWavelengths) {
    wavelength_.push_back(coordinate);
    tables_.push_back(rays.trace(starts_, wavelength_at(lens, coordinate)));
    const RayTable& table = tables_.back();
    double largest = 0.0;
    for (std::size_t k = 0; k < table.size(); ++k) {
      if (table.clearance(k) > 1.0) continue;
      largest = std::max(largest, static_cast<double>(table.transmission[k]));
      const Sample sample{tables_.size() - 1, k};
      open_.push_back(sample);
      if (std::abs(table.sensor_x_mm[k]) < kLandingNear * length(sensor_half_mm) &&
          std::abs(table.sensor_y_mm[k]) < kLandingNear * length(sensor_half_mm))
        landing_.push_back(sample);
    }
    largest_transmittance_.push_back(largest);
  }
  if (landing_.size() < kFewRays) landing_ = open_;
  blocked_table_ = rays.trace(blocked_starts_, wavelength_at(lens, kBlockedWavelength));
}

double ZoneCheck::value(const ChebyshevSum& sum, const Sample& sample) const {
  return value_of(sum, points_[sample.ray], wavelength_[sample.table]);
}

Vec2 ZoneCheck::value(const ChebyshevVector& vector, const Sample& sample) const {
  const ZonePoint& point = points_[sample.ray];
  return Vec2{point.h * value(vector.along_field, sample), 0.0} + point.p * value(vector.along_pupil, sample);
}

std::vector<double> ZoneCheck::position_errors_mm(const ChebyshevVector& sensor) const {
  std::vector<double> errors;
  for (const Sample& sample : landing_) {
    const RayTable& table = tables_[sample.table];
    errors.push_back(
        length(value(sensor, sample) - Vec2{table.sensor_x_mm[sample.ray], table.sensor_y_mm[sample.ray]}));
  }
  return sorted(std::move(errors));
}

std::vector<double> ZoneCheck::stop_errors(const ChebyshevVector& stop, std::size_t crossing) const {
  std::vector<double> errors;
  for (const Sample& sample : open_) {
    const auto& traced = tables_[sample.table].stop[crossing];
    errors.push_back(length(value(stop, sample) - Vec2{traced[0][sample.ray], traced[1][sample.ray]}));
  }
  return sorted(std::move(errors));
}

std::vector<double> ZoneCheck::rim_errors(const ChebyshevSum& squared, int step) const {
  std::vector<double> errors;
  for (const Sample& sample : open_) {
    const double traced = tables_[sample.table].rim_squared[static_cast<std::size_t>(step)][sample.ray];
    // A radius, whose square has twice the relative error.
    errors.push_back(0.5 * std::abs(value(squared, sample) - traced) / std::max(traced, 0.5));
  }
  return sorted(std::move(errors));
}

std::vector<double> ZoneCheck::transmittance_errors(const ChebyshevSum& transmittance) const {
  std::vector<double> errors;
  for (const Sample& sample : open_)
    errors.push_back(std::abs(value(transmittance, sample) - tables_[sample.table].transmission[sample.ray]) /
                     std::max(largest_transmittance_[sample.table], 1e-30));
  return sorted(std::move(errors));
}

bool ZoneCheck::admits_blocked_light(const LensPolynomials& lens, const PolynomialZone& zone) const {
  const auto admits = [&](const RayStart& start, double wavelength) {
    const PolynomialRay ray = evaluate(lens, zone, start.field, start.entrance_mm, wavelength_at(lens, wavelength));
    double clearance = ray.relative_height;
    for (std::size_t c = 0; c < zone.stop.size(); ++c) clearance = std::max(clearance, length(ray.stop[c]));
    return !(clearance > 1.0);
  };
  const auto admits_any = [&](std::span<const RayStart> starts, const RayTable& table, double wavelength) {
    for (std::size_t k = 0; k < starts.size(); ++k)
      if (table.clearance(k) > 1.0 + kBlockedBy && admits(starts[k], wavelength)) return true;
    return false;
  };
  for (std::size_t t = 0; t < tables_.size(); ++t)
    if (admits_any(starts_, tables_[t], wavelength_[t])) return true;
  return admits_any(blocked_starts_, blocked_table_, kBlockedWavelength);
}

}  // namespace contrejour::inline internal::polynomial
