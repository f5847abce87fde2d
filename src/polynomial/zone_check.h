// SPDX-License-Identifier: Apache-2.0
// Rays left out of a zone's fit, against which each of its polynomials is tested.
#pragma once

#include <cstddef>
#include <vector>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/left_out_rays.h"

namespace contrejour::inline internal::polynomial {

// The errors are those of LeftOutRays.
class ZoneCheck {
 public:
  // sensor_half_mm: half the sensor's size. zone: with its bounds and pupil coordinates.
  ZoneCheck(const LensPolynomials& lens, const GhostRays& rays, const PolynomialZone& zone, Vec2 sensor_half_mm);

  [[nodiscard]] std::vector<double> position_errors_mm(const ChebyshevVector& sensor) const;
  [[nodiscard]] std::vector<double> stop_errors(const ChebyshevVector& stop, std::size_t crossing) const;
  [[nodiscard]] std::vector<double> rim_errors(const ChebyshevSum& squared, int step) const;
  [[nodiscard]] std::vector<double> transmittance_errors(const ChebyshevSum& transmittance) const;

  // True if the zone's polynomials let a ray through that is blocked or fails, with a margin.
  [[nodiscard]] bool admits_blocked_light(const LensPolynomials& lens, const PolynomialZone& zone) const;
  // True if a polynomial places light on the sensor that lands far from it.
  [[nodiscard]] bool brings_light_in(const ChebyshevVector& sensor) const;
  [[nodiscard]] int rays() const { return rays_.open_rays(); }

 private:
  LeftOutRays rays_;
  std::vector<ZonePoint> points_, light_points_;
};

}  // namespace contrejour::inline internal::polynomial
