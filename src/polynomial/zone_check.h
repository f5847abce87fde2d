// SPDX-License-Identifier: Apache-2.0
// Rays left out of a zone's fit, against which each of its polynomials is tested.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {

class ZoneCheck {
 public:
  // sensor_half_mm: half the sensor's size. zone: with its bounds and pupil coordinates.
  ZoneCheck(const LensPolynomials& lens, const GhostRays& rays, const PolynomialZone& zone, Vec2 sensor_half_mm);

  // Errors of all rays that get through, rising; empty if none does. Positions are those of rays that land on the
  // sensor or near it, or of all if few do.
  [[nodiscard]] std::vector<double> position_errors_mm(const ChebyshevVector& sensor) const;
  [[nodiscard]] std::vector<double> stop_errors(const ChebyshevVector& stop, std::size_t crossing) const;
  [[nodiscard]] std::vector<double> rim_errors(const ChebyshevSum& squared, int step) const;
  [[nodiscard]] std::vector<double> transmittance_errors(const ChebyshevSum& transmittance) const;

  // True if the zone's polynomials let a ray through that is blocked or fails, with a margin.
  [[nodiscard]] bool admits_blocked_light(const LensPolynomials& lens, const PolynomialZone& zone) const;
  [[nodiscard]] int rays() const { return static_cast<int>(open_.size()); }

 private:
  struct Sample {
    std::size_t table = 0, ray = 0;
  };
  [[nodiscard]] Vec2 value(const ChebyshevVector& vector, const Sample& sample) const;
  [[nodiscard]] double value(const ChebyshevSum& sum, const Sample& sample) const;

  std::vector<RayStart> starts_;
  std::vector<ZonePoint> points_;
  std::vector<RayStart> blocked_starts_;
  RayTable blocked_table_;
  std::vector<RayTable> tables_;  // one a wavelength
  std::vector<double> wavelength_;  // their coordinates
  std::vector<double> largest_transmittance_;
  std::vector<Sample> open_, landing_;
};

// The value that a fraction of rising values do not exceed; infinite without values.
[[nodiscard]] double quantile(const std::vector<double>& rising, double fraction);

}  // namespace contrejour::inline internal::polynomial
