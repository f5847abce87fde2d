// SPDX-License-Identifier: Apache-2.0
// Rays left out of a fit of the direct image, by which its polynomials are tested.
#pragma once

#include <vector>

#include "contrejour/expert/direct_polynomials.h"
#include "polynomial/direct_rays.h"

namespace contrejour::inline internal::polynomial {

class DirectCheck {
 public:
  DirectCheck(const LensState& lens, const DirectPolynomials& frame);

  // Distances from a point's ray, as `origin` and `direction` have it and the tracer follows it, to the point, in
  // pixels on the sensor and in radii on the stop; rising. Rays that do not arrive count as infinitely far.
  struct Landing {
    std::vector<double> sensor_px, stop;
  };
  [[nodiscard]] Landing landing(const DirectPolynomials& fitted) const;
  [[nodiscard]] std::vector<double> rim_errors(const ChebyshevSum& squared, int step) const;  // radii; rising
  [[nodiscard]] std::vector<double> transmittance_errors(const ChebyshevSum& sum) const;  // of the largest; rising
  // Sets let_through and blocked.
  void count_wrongly_blocked(const DirectPolynomials& fitted, DirectAccuracy& accuracy) const;
  [[nodiscard]] int rays() const { return static_cast<int>(open_.size()); }

 private:
  struct Sample {
    std::size_t wavelength = 0;
    Vec2 sensor_mm, stop;
    CameraRay ray;
  };
  const DirectPolynomials& frame_;
  std::vector<double> lambda_nm_, largest_transmittance_;
  std::vector<OpticalPath> paths_;  // by wavelength
  std::vector<Sample> all_, open_;
};

}  // namespace contrejour::inline internal::polynomial
