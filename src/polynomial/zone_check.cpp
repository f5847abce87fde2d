// SPDX-License-Identifier: Apache-2.0
#include "polynomial/zone_check.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kTestedFields = 13, kTestedAtField = 24, kBlockedAtField = 96;

LeftOutRays left_out_of(const LensPolynomials& lens, const GhostRays& rays, const PolynomialZone& zone,
                        Vec2 sensor_half_mm) {
  const double low = zone.field_low * zone.field_low, high = zone.field_high * zone.field_high;
  std::vector<PolynomialBounds> bounds;
  for (int k = 0; k < kTestedFields; ++k)
    bounds.push_back(bounds_between(zone, std::sqrt(low + (high - low) * (k + 0.5) / kTestedFields)));
  std::vector<RayStart> starts = starts_within(bounds, kTestedAtField, kFirstLeftOut);
  std::vector<RayStart> blocked = starts_within(bounds, kBlockedAtField, kFirstLeftOut + starts.size());
  return {lens, rays, std::move(starts), std::move(blocked), sensor_half_mm};
}

double value_at(const ChebyshevSum& sum, const ZonePoint& point, const LeftOutRay& sample) {
  return value_of(sum, point, kTestedWavelengths[sample.wavelength]);
}

Vec2 vector_at(const ChebyshevVector& vector, const ZonePoint& point, const LeftOutRay& sample) {
  return Vec2{point.h * value_at(vector.along_field, point, sample), 0.0} +
         point.p * value_at(vector.along_pupil, point, sample);
}

}  // namespace

ZoneCheck::ZoneCheck(const LensPolynomials& lens, const GhostRays& rays, const PolynomialZone& zone,
                     Vec2 sensor_half_mm)
    : rays_(left_out_of(lens, rays, zone, sensor_half_mm)) {
  for (const RayStart& start : rays_.starts()) {
    points_.push_back(zone_point(zone, start.field, start.entrance_mm));
    light_points_.push_back(points_.back().of_light());
  }
}

std::vector<double> ZoneCheck::position_errors_mm(const ChebyshevVector& sensor) const {
  return rays_.position_errors_mm(
      [&](const LeftOutRay& sample) { return vector_at(sensor, light_points_[sample.ray], sample); });
}

std::vector<double> ZoneCheck::stop_errors(const ChebyshevVector& stop, std::size_t crossing) const {
  return rays_.stop_errors([&](const LeftOutRay& sample) { return vector_at(stop, points_[sample.ray], sample); },
                           crossing);
}

std::vector<double> ZoneCheck::rim_errors(const ChebyshevSum& squared, int step) const {
  return rays_.rim_errors([&](const LeftOutRay& sample) { return value_at(squared, points_[sample.ray], sample); },
                          step);
}

std::vector<double> ZoneCheck::transmittance_errors(const ChebyshevSum& transmittance) const {
  return rays_.transmittance_errors(
      [&](const LeftOutRay& sample) { return value_at(transmittance, light_points_[sample.ray], sample); });
}

bool ZoneCheck::brings_light_in(const ChebyshevVector& sensor) const {
  return rays_.brings_light_in(
      [&](const LeftOutRay& sample) { return vector_at(sensor, light_points_[sample.ray], sample); });
}

bool ZoneCheck::admits_blocked_light(const LensPolynomials& lens, const PolynomialZone& zone) const {
  const auto clearance_from = [&](const std::vector<RayStart>& starts) {
    return [&](const LeftOutRay& sample) {
      const RayStart& start = starts[sample.ray];
      const PolynomialRay ray = evaluate(lens, zone, start.field, start.entrance_mm,
                                         wavelength_at(lens, kTestedWavelengths[sample.wavelength]));
      double clearance = ray.relative_height;
      for (std::size_t c = 0; c < zone.stop.size(); ++c) clearance = std::max(clearance, length(ray.stop[c]));
      return clearance;
    };
  };
  return rays_.admits_blocked_light(clearance_from(rays_.starts()), clearance_from(rays_.blocked_starts()));
}

}  // namespace contrejour::inline internal::polynomial
